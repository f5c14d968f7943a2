"""Warm: imported once by the process that workers are forked from, it loads libraries and kernels for all.

A square with a bar and a dent is traced and written, in a folder that goes again: the kernels of head and
recorder are then loaded, or compiled on the first run. A worker that replaces one that died then starts
within some milliseconds.

Source: our own; `multiprocessing` calls it a preload of its fork server. Questions: libraries that have
started threads must not be forked, so they are kept to one thread before they are loaded.
"""

from __future__ import annotations

import warnings
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory

from morfax.batch import worker

SIDE_PX, DPI = 300, 300.0
OUTLINE_PX = ((60, 60), (240, 60), (240, 240), (160, 240), (150, 200), (140, 240), (60, 240))
BAR_PX = ((60, 100), (240, 130))


def warm_up() -> None:
    """Trace a square of 15 mm."""
    import cv2
    import numpy as np

    from morfax.jobs.settings.drawing_file import DrawingFile
    from morfax.jobs.trace import TraceJob, TraceOutputs

    sheet = np.full((SIDE_PX, SIDE_PX), 255, np.uint8)
    cv2.polylines(sheet, [np.array(OUTLINE_PX)], True, 0, 6, cv2.LINE_AA)
    cv2.polylines(sheet, [np.array(BAR_PX)], False, 0, 6, cv2.LINE_AA)
    with TemporaryDirectory(prefix="morfax-") as folder:
        file = Path(folder, "square.png")
        file.write_bytes(cv2.imencode(".png", sheet)[1].tobytes())
        outputs = TraceOutputs(file.with_suffix(".ngc"), file.with_suffix(".csv"))
        TraceJob(DrawingFile(file, dpi=DPI), outputs).run()


# Kernels that are compiled here have other processes compile ahead: children that the fork server does not
# know, which it says and passes over.
warnings.filterwarnings("ignore", message="forkserver: waitpid returned unexpected pid")
worker.keep_to_one_core()
worker.forgive_damaged_kernels()
with suppress(Exception):  # what is wrong shows on the first drawing, with a word
    warm_up()
