"""Speed and memory, side by side with what one would use instead, as ratios in one run."""
