"""Pictures, tables and pages, made of the results of jobs.

`pictures` draws what belongs to each job's result; `table` shows figures as text and as JSON. Both faces ask
this room; it asks jobs, and the machines below.
"""
