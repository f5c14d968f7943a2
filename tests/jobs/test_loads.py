"""What jobs load, and what comes back of them from another process."""

from __future__ import annotations

import pickle
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image

from morfax.motion.faults import (
    CardFault,
    Fault,
    FileFault,
    FollowingFault,
    LineFault,
    LockFault,
)
from tests.console.conftest import SAMPLES
from tests.jobs.worked import CURVE

pytestmark = pytest.mark.usefixtures("silent")


MODULES = [
    "trace",
    "run",
    "record",
    "play",
    "check",
    "compare",
    "systems",
    "inspect",
    "mend",
    "age",
    "listener",
    "settings.settings",
    "kernels",
]


def test_jobs_know_no_terminal_and_load_no_machine() -> None:
    """Imported, they wait for nothing heavy; running, they never need click or rich."""
    absent = ["click", "rich", "numba", "scipy", "cv2", "soundfile", "matplotlib"]
    code = (
        "import importlib, sys\n"
        f"for name in {MODULES}: importlib.import_module('morfax.jobs.' + name)\n"
        f"print([name for name in {absent} if name in sys.modules])\n"
        "from pathlib import Path\n"
        "from morfax.jobs import TraceJob\n"
        "from morfax.jobs.settings.drawing_file import DrawingFile\n"
        "from morfax.jobs.trace import TraceOutputs\n"
        "import tempfile\n"
        "with tempfile.TemporaryDirectory() as folder:\n"
        f"    job = TraceJob(DrawingFile(Path({str(CURVE.file)!r})), TraceOutputs(Path(folder, 'a.csv')))\n"
        "    job.run()\n"
        "print([name for name in ('click', 'rich', 'matplotlib') if name in sys.modules])\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    assert done.stdout.splitlines() == ["[]", "[]"]


def test_a_plain_trace_loads_neither_masked_arrays_nor_what_other_drawings_need(
    tmp_path: Path,
) -> None:
    """numpy.ma alone (np.percentile and np.unique ask for it) takes a twentieth of a short trace."""
    absent = [
        "numpy.ma",
        "morfax.tracer.corrections.corrections",
        "morfax.tracer.following.edge_follower",
        "morfax.tracer.tangles.sketch",
        "morfax.motion.offset",
        "morfax.jobs.trace_each",
    ]
    words = ["trace", str(SAMPLES / "cam.png"), "-o", str(tmp_path / "a.wav")]
    code = (
        "import sys; from morfax.console.cli import main;"
        f" code = main({words}); print(code, [name for name in {absent} if name in sys.modules])"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    assert done.stdout.splitlines()[-1] == "0 []"


@pytest.mark.parametrize(
    ("lines", "left_out"), [("all", "scipy"), ("contours", "scipy.spatial")]
)
def test_a_plate_is_followed_without_scipy(tmp_path: Path, lines: str, left_out: str) -> None:
    """scipy.spatial takes as long to import as numpy, numba and OpenCV together, and 37 MB."""
    grey = np.full((500, 500), 240, np.uint8)
    for k in range(9):
        cv2.circle(grey, (100 + 150 * (k % 3), 100 + 150 * (k // 3)), 45, 40, 6, cv2.LINE_AA)
    if lines == "contours":  # a bar, whose ink is left
        cv2.line(grey, (145, 100), (205, 100), 40, 6, cv2.LINE_AA)
    Image.fromarray(grey).save(tmp_path / "plate.png", dpi=(300, 300))
    words = ["trace", str(tmp_path / "plate.png"), "--lines", lines, "-o"]
    code = (
        "import sys; from morfax.console.cli import main;"
        f" code = main({[*words, str(tmp_path / 'plate.csv')]});"
        f" print(code, [name for name in sys.modules if name.startswith('{left_out}')])"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    assert done.stdout.splitlines()[-1] == "0 []"


@pytest.mark.parametrize(
    "fault",
    [
        LineFault("lost", x_mm=1.0, y_mm=2.0, heading_rad=0.5, nearest_mm=(3.0, 4.0)),
        LockFault("lock", axis="x", time_s=1.0, error_cycles=0.5, position_mm=2.0),
        FollowingFault("lag", axis="y", time_s=1.0, demand_mm=2.0, actual_mm=1.0, limit_mm=0.5),
        CardFault("card", line=3, field="depth", holds="deep"),
        FileFault("cannot write a.wav"),
    ],
)
def test_a_fault_comes_back_from_another_process_with_all_that_it_carries(fault: Fault) -> None:
    back = pickle.loads(pickle.dumps(fault))
    assert type(back) is type(fault) and str(back) == str(fault) and vars(back) == vars(fault)
