"""The command line: parses words into jobs, asks the operator, and shows results. Nobody imports it."""
