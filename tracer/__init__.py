"""The line follower: a drawing becomes a Motion (patent ES 361967, figure 1)."""
