"""The differences of cubics: recorder and file (SEA 1957, patent US 3062995).

It asks motion/ only. Jobs ask `cubics.record_cubics`; the player asks `file`.
"""
