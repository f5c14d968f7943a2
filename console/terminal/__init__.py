"""The terminal: the desk that shows what a job does, and the operator who answers its questions.

The verbs and the options ask this room; it asks `jobs` and `reports`.
"""
