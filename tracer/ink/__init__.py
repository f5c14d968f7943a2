"""All the ink of a sheet: a ledger of what has been followed, and the rounds in which the head follows the rest.

The room asks `following` for runs of the head; `program` puts its strokes in order.
"""
