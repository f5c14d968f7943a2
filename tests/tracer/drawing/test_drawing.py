"""The drawing: every kind of image, its scale, its paper; the line lies in sheet mm where it was drawn."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from morfax.motion.faults import DrawingFault, FileFault
from morfax.motion.units import MM_PER_INCH
from morfax.tracer.drawing.drawing import Drawing
from tests.tracer.inked import UM, arc, inked, polyline

DPI = (300.0, 300.0)
PEN_MM = 1 * UM  # to which the pen draws: a tenth of its fine pixels of 10.6 um
LINE = polyline((4, 5), (34, 11))  # aslant, so that it crosses pixels at every phase
Grey = NDArray[np.uint8]


@pytest.fixture(scope="module")
def grey() -> Grey:
    """Grey values of a line of 0.5 mm on white paper."""
    return np.round(255 - 215 * inked(LINE).darkness).astype(np.uint8)


def off_the_line_mm(drawing: Drawing) -> NDArray[np.float64]:
    """How far above the drawn line the middle of its ink is, column by column, its ends left out, mm."""
    x = (np.arange(drawing.darkness.shape[1]) + 0.5) * drawing.pitch_mm
    y = (
        drawing.darkness.shape[0] - np.arange(drawing.darkness.shape[0]) - 0.5
    ) * drawing.pitch_mm
    told = np.interp(x, *LINE.T)
    dark = np.where(np.abs(y[:, None] - told) < 1.0, np.clip(drawing.darkness, 0, None), 0.0)
    inner = (x > LINE[0, 0] + 1) & (x < LINE[1, 0] - 1)
    return ((dark * y[:, None]).sum(axis=0) / np.maximum(dark.sum(axis=0), 1e-9) - told)[inner]


def opened(image: Image.Image, file: Path, **stated: object) -> Drawing:
    """Save an image under a name and open it as a drawing."""
    image.save(file, **stated)
    return Drawing.open(file)


KINDS: dict[str, Callable[[Grey], Image.Image]] = {
    "grey.png": Image.fromarray,
    "grey.tif": Image.fromarray,
    "grey.jpg": Image.fromarray,
    "grey.bmp": Image.fromarray,
    "sixteen.png": lambda g: Image.fromarray(g.astype(np.uint16) * 257),
    "sixteen.tif": lambda g: Image.fromarray(g.astype(np.uint16) * 257),
    "thirtytwo.tif": lambda g: Image.fromarray(g.astype(np.int32) * 257),
    "float.tif": lambda g: Image.fromarray(g.astype(np.float32)),
    "colour.png": lambda g: Image.fromarray(g).convert("RGB"),
    "colour.jpg": lambda g: Image.fromarray(g).convert("RGB"),
    "palette.png": lambda g: Image.fromarray(g).convert("P"),
    "cmyk.tif": lambda g: Image.fromarray(g).convert("CMYK"),
    "cmyk.jpg": lambda g: Image.fromarray(g).convert("CMYK"),
    "alpha.png": lambda g: Image.fromarray(g).convert("LA"),
    "coloured-alpha.tif": lambda g: Image.fromarray(g).convert("RGBA"),
    "ink-in-the-alpha.png": lambda g: Image.merge(
        "LA", (Image.new("L", g.shape[::-1], 0), Image.fromarray(255 - g))
    ),  # black all over, and the paper transparent
    "red-line.png": lambda g: Image.merge(
        "RGB", (Image.new("L", g.shape[::-1], 255), Image.fromarray(g), Image.fromarray(g))
    ),
}


@pytest.mark.parametrize("name", KINDS)
def test_every_kind_of_image_has_its_line_where_it_was_drawn(
    tmp_path: Path, grey: Grey, name: str
) -> None:
    drawing = opened(KINDS[name](grey), tmp_path / name, dpi=DPI)
    off_mm = off_the_line_mm(drawing)
    assert abs(off_mm.mean()) < PEN_MM
    assert off_mm.std() < (
        5 * UM if name.endswith("jpg") else 1 * UM
    )  # the ripple of JPEG, 6 % of a pixel of 85 um
    assert drawing.darkness.dtype == np.float32
    assert drawing.pitch_mm == pytest.approx(MM_PER_INCH / 300, rel=1e-9)


def test_a_1_bit_image_has_its_line_where_it_was_drawn(tmp_path: Path, grey: Grey) -> None:
    image = Image.fromarray(grey).convert("1", dither=Image.Dither.NONE)
    off_mm = off_the_line_mm(opened(image, tmp_path / "bits.tif", dpi=DPI))
    assert (
        abs(off_mm.mean()) < 2 * UM
    )  # both edges are rounded to whole pixels of 85 um: 24 um RMS each, over 330 columns
    assert off_mm.std() < 0.3 * 85 * UM  # the mean of two edges, 1/sqrt(12) of a pixel each


def test_ink_is_one_and_paper_nothing(tmp_path: Path, grey: Grey) -> None:
    drawing = opened(Image.fromarray(grey), tmp_path / "a.png", dpi=DPI)
    assert np.percentile(drawing.darkness, 50) == pytest.approx(0, abs=0.01)
    assert drawing.darkness.max() == pytest.approx(
        1, abs=0.1
    )  # a narrow line's ink is soft; its darker part counts


def test_the_sheet_is_as_large_as_its_pixels(tmp_path: Path, grey: Grey) -> None:
    drawing = opened(Image.fromarray(grey), tmp_path / "a.png", dpi=DPI)
    assert drawing.width_mm == pytest.approx(grey.shape[1] * MM_PER_INCH / 300)
    assert drawing.height_mm == pytest.approx(grey.shape[0] * MM_PER_INCH / 300)


# scale


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


# paper and ink


def test_light_on_dark_is_found_out(tmp_path: Path, grey: Grey) -> None:
    """A blueprint."""
    drawing = opened(Image.fromarray(255 - grey), tmp_path / "blue.png", dpi=DPI)
    as_usual = opened(Image.fromarray(grey), tmp_path / "a.png", dpi=DPI)
    assert np.abs(drawing.darkness - as_usual.darkness).max() < 1 / 215  # a grey level


def test_uneven_paper_is_levelled(tmp_path: Path, grey: Grey) -> None:
    """The lamp's light falls off to a half towards one side; the ink stays as dark, relative to the paper
    there.
    """
    light = np.linspace(1.0, 0.5, grey.shape[1])[None, :]
    drawing = opened(
        Image.fromarray(np.round(grey * light).astype(np.uint8)), tmp_path / "a.png", dpi=DPI
    )
    assert np.abs(off_the_line_mm(drawing)).max() < 3 * UM
    assert (
        np.abs(np.median(drawing.darkness, axis=0)).max() < 0.1
    )  # paper that falls by 0.08 in 6 mm
    ridge = drawing.darkness.max(axis=0)[60:-60]  # the ends left out
    assert (
        ridge.min() > 0.7 and ridge.max() < 1.4
    )  # the contrast is that of the light, 1 to 0.5, about 1 in the middle


@pytest.mark.parametrize("level", [255, 0, 128])
def test_a_blank_sheet_holds_no_line(tmp_path: Path, level: int) -> None:
    with pytest.raises(DrawingFault, match=r"no line on the drawing: .*; check the file"):
        opened(
            Image.fromarray(np.full((400, 600), level, np.uint8)), tmp_path / "a.png", dpi=DPI
        )


def test_dirt_is_no_line(tmp_path: Path) -> None:
    """Paper with a scanner's noise and specks shorter than a line."""
    random = np.random.default_rng(7)
    sheet = 235 + random.normal(0, 8, (500, 700))
    for row, column in random.integers(10, 480, (60, 2)):
        sheet[row : row + 6, column : column + 6] = 60
    with pytest.raises(DrawingFault, match="no line on the drawing"):
        opened(
            Image.fromarray(np.clip(sheet, 0, 255).astype(np.uint8)),
            tmp_path / "a.png",
            dpi=DPI,
        )


# files


@pytest.mark.filterwarnings(
    "ignore::pytest.PytestUnraisableExceptionWarning"
)  # Pillow leaves a damaged file open
@pytest.mark.filterwarnings("ignore::ResourceWarning")
def test_what_is_no_image_is_told(tmp_path: Path, grey: Grey) -> None:
    (tmp_path / "words.png").write_text("these are words")
    with pytest.raises(
        DrawingFault, match=r"words\.png is not an image .* give a PNG, JPEG or TIFF"
    ):
        Drawing.open(tmp_path / "words.png")
    Image.fromarray(grey).save(tmp_path / "whole.png", dpi=DPI)
    (tmp_path / "cut.png").write_bytes((tmp_path / "whole.png").read_bytes()[:700])
    with pytest.raises(
        DrawingFault, match=r"cut\.png is a damaged image .* scan or save it again"
    ):
        Drawing.open(tmp_path / "cut.png")


def test_a_file_that_is_not_there_or_cannot_be_read_is_told(tmp_path: Path) -> None:
    with pytest.raises(FileFault, match="does not exist"):
        Drawing.open(tmp_path / "missing.png")
    with pytest.raises(FileFault, match="cannot be read"):
        Drawing.open(tmp_path)


@pytest.mark.parametrize(("period_px", "ink_px"), [(16, 8), (5, 2)])
def test_a_pattern_that_is_all_over_the_sheet_is_told(
    tmp_path: Path, period_px: int, ink_px: int
) -> None:
    """It was told as "580 or more of 255 grey levels", and "scan it with more contrast": black on white."""
    y, x = np.mgrid[:400, :400]
    hatched = np.where((x + y) % period_px < ink_px, 0, 255).astype(np.uint8)
    Image.fromarray(hatched).save(tmp_path / "hatched.png", dpi=DPI)
    with pytest.raises(
        DrawingFault, match="vary everywhere, as in noise, hatching or a pattern"
    ):
        Drawing.open(tmp_path / "hatched.png")


def test_bold_lines_that_take_half_of_the_picture_are_no_pattern(tmp_path: Path) -> None:
    """Squares within squares, 5 mm broad and 6 mm apart: their levels differ, those of neighbours do not."""
    y, x = np.abs(np.mgrid[-256:256, -256:256])
    away_px = np.maximum(x, y)
    bold = np.where((away_px % 44 < 20) & (away_px < 245), 0, 255).astype(np.uint8)
    Image.fromarray(bold).save(tmp_path / "bold.png", dpi=(100, 100))
    widths_mm = Drawing.open(tmp_path / "bold.png").sheet.widths_mm
    assert np.abs(widths_mm[:5] - 20 * MM_PER_INCH / 100).max() < 0.05  # a fifth of a pixel


def test_a_tiff_whose_next_page_has_no_size_is_damaged(tmp_path: Path) -> None:
    """Pillow ends with a TypeError."""
    file = tmp_path / "a.tif"
    Image.fromarray(np.full((40, 60), 255, np.uint8)).save(file, dpi=DPI)
    whole = file.read_bytes()
    next_at = 10 + 12 * int.from_bytes(whole[8:10], "little")  # behind all entries of the page
    pointer = len(whole).to_bytes(4, "little")  # to a page of no entry
    file.write_bytes(whole[:next_at] + pointer + whole[next_at + 4 :] + bytes(6))
    with pytest.raises(DrawingFault, match=r"is a damaged image \(.*\); scan or save it again"):
        Drawing.open(file)
