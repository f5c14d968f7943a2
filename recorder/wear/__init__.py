"""TODO: what lives in this room, and its door."""
