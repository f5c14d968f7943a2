"""The punched tape of step vectors: recorder and file (Superior Electric 1975, patent ES 443122).

It asks motion/ only. Jobs ask `steps.record_steps`; the player asks `file` and `rings`.
"""
