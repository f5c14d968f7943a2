"""A program read as a machine's control would read it, and what the control or the work would not take.

It asks player.gcode's reader and the machine's data (recorder.gcode.machine). Jobs ask
`checked.check_program`.
"""
