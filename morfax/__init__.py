"""morfax: a drawing on paper becomes a program for a machine.

The door of the library. The whole way in a few lines:

    import morfax

    drawing = morfax.Drawing.open("cam.png")
    motion = morfax.trace(drawing)
    morfax.record(motion, "cam.wav")
    played = morfax.play("cam.wav")
    print(morfax.distance(motion, played))
    print(morfax.deviation(drawing, played))
"""
