"""The tape control: carrier tracks drive the axes through a phase lock (Morfax 1969, patent ES 361967).

It asks motion/, recorder/tape and player/monitor. Jobs ask `playback.play`, `mend.mend`, `setting.Setting`.
"""
