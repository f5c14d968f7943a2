"""The door: `import morfax` loads nothing heavy, and the lines of its docstring run as they stand there."""

from __future__ import annotations

import shutil
import subprocess
import sys
import textwrap
from pathlib import Path

import numpy as np
import pytest

import morfax
from morfax.motion.motion import Motion

SAMPLES = Path(__file__).parents[2] / "samples"
# what may only load when a name of the door is used; numpy alone takes longer than the 0.05 s of the door
HEAVY = (
    "numpy",
    "numba",
    "scipy",
    "cv2",
    "skimage",
    "click",
    "rich",
    "matplotlib",
    "soundfile",
    "PIL",
)
UM = 1e-3  # mm


def python(code: str, folder: Path | None = None) -> str:
    """Run some lines in a fresh interpreter, and give what it prints."""
    command = [sys.executable, "-c", code]
    return subprocess.run(
        command, check=True, capture_output=True, text=True, cwd=folder
    ).stdout


def lines() -> str:
    """The lines of the docstring, from its import on."""
    assert morfax.__doc__ is not None
    first = morfax.__doc__.index("    import morfax\n")
    return textwrap.dedent(morfax.__doc__[first:].split("\n`import", 1)[0])


def test_the_door_loads_nothing_heavy() -> None:
    loaded = python("import sys, morfax; dir(morfax); print(*sys.modules)").split()
    assert [name for name in loaded if name.partition(".")[0] in HEAVY] == []
    assert [name for name in loaded if name.startswith("morfax.")] == []


def test_every_name_of_the_door_is_there() -> None:
    assert len(morfax.__all__) <= 12
    for name in morfax.__all__:
        assert callable(getattr(morfax, name)), name
    assert dir(morfax) == sorted(morfax.__all__)
    with pytest.raises(AttributeError, match="no attribute 'polish'"):
        _ = morfax.polish  # type: ignore[attr-defined]


def test_the_lines_of_the_docstring_run_as_they_stand(tmp_path: Path) -> None:
    shutil.copy(SAMPLES / "cam.png", tmp_path)
    path = str(Path(__file__).parents[2])
    told = python(f"import sys; sys.path.insert(0, {path!r})\n{lines()}", tmp_path)
    assert told.startswith("path to reference RMS 0.0000")
    assert "of the ink missed" in told
    assert (tmp_path / "cam.wav").exists()


def test_the_measures_take_a_stream_a_block_and_polylines() -> None:
    t = np.linspace(0, 2 * np.pi, 6001)
    circle = np.column_stack([20 * np.cos(t), 20 * np.sin(t), np.full_like(t, -1.0)])
    larger = Motion(circle * [1.001, 1.001, 1.0])
    block = Motion(circle)
    for path in (block, [block], iter([block]), morfax.thin([block])):
        found = morfax.distance(path, [larger.positions_mm[:, :2]])
        # 20 mm of radius against 20.02 mm; thinning may move a point by 0.2 um on each axis
        assert found.hausdorff_mm == pytest.approx(20 * UM, abs=0.4 * UM)
