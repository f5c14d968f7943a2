"""The magnetic tape: carrier tracks in a sound file, written and read (Morfax 1969, patent ES 361967).

It asks motion/ only. `tape` is what jobs and the player ask: `Tape`, `TapeFormat`, `record`.
"""
