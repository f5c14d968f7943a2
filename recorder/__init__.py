"""The recording units: a Motion becomes a program file (patent ES 361967, figures 2 to 4)."""
