"""The scale that a file states, or somebody gives, and how its picture lies."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from morfax.motion.faults import DrawingFault
from morfax.motion.units import MM_PER_INCH
from morfax.tracer.drawing.drawing import Drawing
from tests.tracer.drawing.images import DPI, PEN_MM, Grey, off_the_line_mm, opened
from tests.tracer.inked import arc, inked


@pytest.mark.parametrize("dpi", [75, 100, 150, 200, 300, 400, 600, 1200])
def test_a_png_s_dots_per_metre_mean_a_whole_number_per_inch(
    tmp_path: Path, grey: Grey, dpi: int
) -> None:
    """PNG keeps whole pixels per metre: 300 dpi is 11811, which reads back as 299.9994."""
    drawing = opened(Image.fromarray(grey), tmp_path / "a.png", dpi=(dpi, dpi))
    assert drawing.pitch_mm == MM_PER_INCH / dpi


def test_a_resolution_that_is_no_whole_number_stays_so(tmp_path: Path, grey: Grey) -> None:
    drawing = opened(Image.fromarray(grey), tmp_path / "a.tif", dpi=(304.8, 304.8))
    assert drawing.pitch_mm == pytest.approx(1 / 12, rel=1e-6)


def test_resolution_and_width_by_hand_go_before_the_file(tmp_path: Path, grey: Grey) -> None:
    Image.fromarray(grey).save(tmp_path / "a.png", dpi=(72, 72))
    assert Drawing.open(tmp_path / "a.png", dpi=300).pitch_mm == MM_PER_INCH / 300
    assert Drawing.open(tmp_path / "a.png", width_mm=120).width_mm == pytest.approx(120)


def test_both_resolution_and_width_are_refused(tmp_path: Path, grey: Grey) -> None:
    Image.fromarray(grey).save(tmp_path / "a.png")
    with pytest.raises(DrawingFault, match=r"both .* give one of --dpi and --width"):
        Drawing.open(tmp_path / "a.png", dpi=300, width_mm=100)


@pytest.mark.parametrize(
    "scale",
    [{"dpi": v} for v in (0.0, -300.0, np.nan, np.inf, 1e-300)]
    + [{"width_mm": v} for v in (0.0, 1e-3, 1e6)],
)
def test_a_nonsense_scale_is_told(tmp_path: Path, grey: Grey, scale: dict[str, float]) -> None:
    Image.fromarray(grey).save(tmp_path / "a.png", dpi=DPI)
    with pytest.raises(
        DrawingFault,
        match=r"--(dpi|width) is .*; it must give pixels of 0.001 to 10 mm, 2.54 to 2.54e\+04 dpi",
    ):
        Drawing.open(tmp_path / "a.png", **scale)


ASKS = r"states no resolution; give --dpi 300, or the sheet's width with --width 120mm"


@pytest.mark.parametrize("name", ["a.png", "a.tif", "a.jpg", "a.bmp"])
def test_no_resolution_asks_for_one(tmp_path: Path, grey: Grey, name: str) -> None:
    stated = {"dpi": (0, 0)} if name == "a.bmp" else {}
    with pytest.raises(DrawingFault, match=ASKS):
        opened(Image.fromarray(grey), tmp_path / name, **stated)


def test_a_photograph_s_exif_without_resolution_is_no_72_dpi(
    tmp_path: Path, grey: Grey
) -> None:
    """Pillow answers 72 dpi for it."""
    exif = Image.Exif()
    exif[0x010F] = "a camera's maker"
    Image.fromarray(grey).save(tmp_path / "a.jpg", exif=exif)
    jfif = (tmp_path / "a.jpg").read_bytes()
    first = 4 + int.from_bytes(jfif[4:6], "big")
    (tmp_path / "b.jpg").write_bytes(
        jfif[:2] + jfif[first:]
    )  # as cameras write it: no JFIF segment at all
    for name in ("a.jpg", "b.jpg"):
        with pytest.raises(DrawingFault, match=ASKS):
            Drawing.open(tmp_path / name)


def test_a_jpeg_s_own_resolution_counts(tmp_path: Path, grey: Grey) -> None:
    assert (
        opened(Image.fromarray(grey), tmp_path / "a.jpg", dpi=(300, 300)).pitch_mm
        == MM_PER_INCH / 300
    )
    assert (
        opened(Image.fromarray(grey), tmp_path / "b.jpg", dpi=(75, 75)).pitch_mm
        == MM_PER_INCH / 75
    )


@pytest.mark.parametrize("dpi", [72, 96])
@pytest.mark.parametrize("name", ["a.png", "a.tif", "a.jpg"])
def test_a_placeholder_is_no_resolution(
    tmp_path: Path, grey: Grey, name: str, dpi: int
) -> None:
    asks = (
        rf"states {dpi} dpi, which is what programs write.*; .*--dpi {dpi} if.*--flatten paper"
    )
    with pytest.raises(DrawingFault, match=asks):
        opened(Image.fromarray(grey), tmp_path / name, dpi=(dpi, dpi))
    assert (
        Drawing.open(tmp_path / name, dpi=dpi).pitch_mm == MM_PER_INCH / dpi
    )  # the advice works


def test_what_a_camera_states_is_no_resolution_and_what_a_scanner_states_is_one(
    tmp_path: Path, grey: Grey
) -> None:
    exif = Image.Exif()
    exif[0x010F], exif[0x0110] = "a maker", "a model"
    Image.fromarray(grey).save(tmp_path / "scan.jpg", exif=exif, dpi=(240, 240))
    assert Drawing.open(tmp_path / "scan.jpg").pitch_mm == MM_PER_INCH / 240
    exif.get_ifd(0x8769)[0x920A] = 4.25  # the focal length, mm
    Image.fromarray(grey).save(tmp_path / "photo.jpg", exif=exif, dpi=(240, 240))
    with pytest.raises(
        DrawingFault, match=r"states 240 dpi, but a camera took it, .*--width 120mm"
    ):
        Drawing.open(tmp_path / "photo.jpg")
    assert Drawing.open(tmp_path / "photo.jpg", width_mm=120).width_mm == pytest.approx(120)


@pytest.mark.parametrize("stated", [(1.0, 1.0), (0.001, 0.001)])
def test_a_nonsense_resolution_in_the_file_counts_as_none(
    tmp_path: Path, grey: Grey, stated: tuple[float, float]
) -> None:
    with pytest.raises(DrawingFault, match=ASKS):
        opened(Image.fromarray(grey), tmp_path / "a.tif", dpi=stated)


def test_oblong_pixels_are_made_square(tmp_path: Path) -> None:
    """A fax has 204 x 98 dots per inch; a circle on it is round."""
    drawn = inked(arc((14, 14), 10), dpi=204)
    every_other = Image.fromarray(np.round(255 - 215 * drawn.darkness).astype(np.uint8))
    every_other = every_other.resize(
        (every_other.width, round(every_other.height * 98 / 204)), Image.Resampling.BOX
    )
    drawing = opened(every_other, tmp_path / "fax.tif", dpi=(204, 98))
    assert drawing.width_mm == pytest.approx(drawing.height_mm, abs=MM_PER_INCH / 98)
    rows, columns = np.nonzero(drawing.darkness > 0.5)
    assert np.ptp(rows) == pytest.approx(
        np.ptp(columns), abs=204 / 98 + 1
    )  # one pixel of the fax
    assert np.ptp(columns) * drawing.pitch_mm == pytest.approx(20.5, abs=2 * drawing.pitch_mm)


@pytest.mark.parametrize("orientation", range(1, 9))
def test_a_turned_photograph_is_set_upright(
    tmp_path: Path, grey: Grey, orientation: int
) -> None:
    """Exif says how the camera was held: the pixels are stored turned or mirrored."""
    upright = Image.fromarray(grey)
    turns = Image.Transpose
    undo = {2: turns.FLIP_LEFT_RIGHT, 3: turns.ROTATE_180, 4: turns.FLIP_TOP_BOTTOM, 5: turns.TRANSPOSE,
            6: turns.ROTATE_90, 7: turns.TRANSVERSE, 8: turns.ROTATE_270}  # fmt: skip
    stored = upright.transpose(undo[orientation]) if orientation > 1 else upright
    exif = Image.Exif()
    exif[0x0112] = orientation
    for file, stated in (
        (tmp_path / "a.tif", {"compression": "tiff_lzw"}),
        (tmp_path / "a.jpg", {"quality": 90}),
    ):
        drawing = opened(stored, file, exif=exif, dpi=DPI, **stated)
        assert drawing.darkness.shape == grey.shape
        assert abs(off_the_line_mm(drawing).mean()) < PEN_MM
