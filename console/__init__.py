"""Command line, pictures and reports: everything that prints, asks or draws."""
