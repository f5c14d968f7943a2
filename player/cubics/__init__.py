"""The cubic control: an interpolator of differences drives servos (SEA 1957, patent US 3062995).

It asks motion/, recorder/cubics and player/monitor. Jobs ask `cubic.play_cubic`.
"""
