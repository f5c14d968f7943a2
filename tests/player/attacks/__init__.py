"""Attacks on tapes: what is done to a checked tape, and what must come of it; `make soak` tries all."""
