"""What the operator has put right on a drawing: ink rubbed out or drawn, turns, stops, start; and its file.

The room asks the ground floor only. The drawing takes the ink from it, the lines take turns and stops, and
the jobs read and write its file.
"""
