"""The wear of a tape: what a recorder, its tape and the years do to the tracks.

It asks recorder/tape for file formats. Jobs ask `settings` for `Wear` and `SETS`, `transport` for `age`.
"""
