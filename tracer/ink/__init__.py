"""All the ink of a sheet: the ledger of what has been followed, and rounds of the head over what is left.

The room asks `following` for runs of the head; `program` puts its strokes in order.
"""
