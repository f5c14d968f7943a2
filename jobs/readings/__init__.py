"""Readings: figures of a path, a program or a tape, measured for the jobs that report them.

The room asks the media. The jobs ask it.
"""
