"""Fuzzing by hand (`make fuzz`): random and broken input, which must end as a fault and nothing else."""
