"""Remarks: what a report says beside its figures, each text with what to do, and the places it marks.

The room asks the settings. The jobs that trace or list lines ask it.
"""
