"""The machine control: a program file becomes the Motion of a machine (patent ES 361967, figure 5)."""
