"""Lines and arcs in RS-274 G-code: the recorder for LinuxCNC, Grbl and the pulse control.

It asks motion/ only. Jobs ask `blocks.record_blocks`.
"""
