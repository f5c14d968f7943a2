"""The program: one line of the drawing or many, followed, put in order, and cut as a stream of Motion.

The room asks the following and the operator. The cutter and the jobs ask it.
"""
