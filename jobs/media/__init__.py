"""Media: files by their kind, pipes and sound devices, and drawings from CAD.

The room asks the listener. The jobs and their other rooms ask it.
"""
