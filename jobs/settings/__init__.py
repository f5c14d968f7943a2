"""Settings: what may be set of a drawing, its lines, the head, the tool and the zero, checked as a whole.

The room asks the listener. The jobs and the faces ask it.
"""
