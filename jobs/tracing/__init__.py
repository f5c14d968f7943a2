"""Tracing: a drawing followed, for every job that traces one, with its figures.

The room asks the settings, the remarks and the machine's units. The jobs ask it.
"""
