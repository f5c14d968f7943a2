"""The machine controls: a program file becomes the Motion of a simulated machine.

They ask motion/ and the file formats of recorder/, and do not know the tracer. Jobs ask `controls.play`,
which takes the control from the file's suffix; every control has its own room and returns Motion alike.
"""
