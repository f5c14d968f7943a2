"""Lines: which lines a sheet has, which of them are asked for, and in what order they are cut.

The room asks the following and the drawing. All of `program` asks it.
"""
