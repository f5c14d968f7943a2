"""The step control: a punched tape drives stepping motors (Superior Electric 1975, patent ES 443122).

It asks motion/, recorder/steps and player/monitor. Jobs ask `stepping.play_steps`.
"""
