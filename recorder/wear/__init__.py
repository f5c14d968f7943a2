"""The wear of a tape: what a recorder, its tape and the years do to the tracks.

It asks recorder/tape for file formats. Jobs and the tests of the player ask `transport`: `Wear`, `age`, `SETS`.
"""
