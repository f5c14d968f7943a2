"""The operator: the card, the Z unit, and what the tool does at each stop of a line.

The room asks the lines that were followed and the ground floor. The program and the cutter ask it.
"""
