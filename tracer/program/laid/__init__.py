"""Laid: small loops, rim loops, narrow bays and bridges, which are laid by their ink where the head fails.

The room asks the lines and what is held against the ink. The traces of `program` ask it.
"""
