"""Against ink: lines that were followed are held against the ink that they should explain, and what is left.

The room asks the following and the drawing. All of `program` asks it.
"""
