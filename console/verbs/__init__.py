"""The verbs: each turns its options into a job, runs it, and shows the result.

The command line loads a verb when it is called; a verb asks `options` and `terminal`, jobs and reports.
"""
