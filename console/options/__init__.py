"""The options of the command line: what a verb takes, in groups, as plain values for the jobs.

The verbs ask this room; it asks `jobs` for the settings that options become, and `terminal` for the operator.
"""
