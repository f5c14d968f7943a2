"""The recorders: a Motion becomes a program file, each medium in a room of its own.

They ask motion/ only, and know neither tracer nor player. Jobs ask `media.record`, which takes the medium
from the file's suffix; the player asks for the file formats.

Source: patent ES 361967, figures 2 to 4; the other media as their rooms say.
"""
