"""Machine: the machine that a program is for, the unit that records a program, and the control that plays it.

The room asks the settings and the media. The jobs ask it.
"""
