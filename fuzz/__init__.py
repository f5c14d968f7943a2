"""Fuzzing by hand (`make fuzz`): random and broken input must be read or end in a fault, nothing else."""
