"""Ground floor: what all the other packages speak."""
