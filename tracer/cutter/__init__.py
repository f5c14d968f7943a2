"""The cutter: a program moved aside by a cutter's radius, with its lead line, stops and guide lines; and the
way round, the start and the leads of closed lines, with a cutter or without.

The room asks the program and the offset paths of the ground floor. The jobs ask it.
"""
