"""Phones' and the web's formats, HEIC, AVIF and WebP: upright, with their resolution, and their camera."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from morfax.motion.faults import DrawingFault
from morfax.motion.units import MM_PER_INCH
from morfax.tracer.drawing import raster
from morfax.tracer.drawing.drawing import Drawing
from tests.tracer.inked import inked, polyline

LINE = polyline((4, 5), (34, 11))
NAMES = ("a.heic", "a.avif", "a.webp")
TURNS = Image.Transpose
# how an upright picture is stored so that Exif's orientation sets it upright again
STORED = {2: TURNS.FLIP_LEFT_RIGHT, 3: TURNS.ROTATE_180, 4: TURNS.FLIP_TOP_BOTTOM, 5: TURNS.TRANSPOSE,
          6: TURNS.ROTATE_90, 7: TURNS.TRANSVERSE, 8: TURNS.ROTATE_270}  # fmt: skip


@pytest.fixture(scope="module")
def grey() -> NDArray[np.uint8]:
    """Grey values of a line of 0.5 mm on white paper, 300 dpi."""
    return np.round(255 - 215 * inked(LINE).darkness).astype(np.uint8)


def tags(
    orientation: int = 1, dpi: float | None = None, per_cm: float | None = None
) -> Image.Exif:
    """Exif of a picture."""
    exif = Image.Exif()
    exif[0x0112] = orientation
    if dpi is not None or per_cm is not None:
        exif[0x011A] = exif[0x011B] = dpi or per_cm
        exif[0x0128] = 2 if dpi else 3
    return exif


def saved(image: Image.Image, file: Path, **how: Any) -> Path:
    """A picture under a name, hardly compressed."""
    from pillow_heif import register_heif_opener

    register_heif_opener()
    if (
        "exif" in how
    ):  # as bytes: pillow-heif then writes the turn that a HEIC is shown by, as phones do
        how["exif"] = how["exif"].tobytes()
    image.convert("RGB").save(file, quality=95, **how)
    return file


@pytest.mark.parametrize("name", NAMES)
def test_a_picture_is_read_with_its_exif_s_resolution(
    tmp_path: Path, grey: NDArray[np.uint8], name: str
) -> None:
    for exif in (tags(dpi=300), tags(per_cm=300 / 2.54)):
        drawing = Drawing.open(saved(Image.fromarray(grey), tmp_path / name, exif=exif))
        assert drawing.pitch_mm == pytest.approx(MM_PER_INCH / 300, rel=1e-6)
        away = np.abs(drawing.darkness - inked(LINE).darkness[: grey.shape[0]])
        # lossy pictures: ten grey levels of 215 at the worst pixel
        assert away.max() < 0.15 and drawing.darkness.shape == grey.shape


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("orientation", [1, 3, 6, 8, 5])
def test_a_turned_picture_is_set_upright(
    tmp_path: Path, grey: NDArray[np.uint8], name: str, orientation: int
) -> None:
    upright = Image.fromarray(grey)
    stored = upright.transpose(STORED[orientation]) if orientation > 1 else upright
    scan = raster.read(saved(stored, tmp_path / name, exif=tags(orientation)), coloured=False)
    assert scan.pixels.shape == grey.shape
    assert np.abs(scan.pixels.astype(int) - grey).mean() < 2  # a mirrored one is off by 10


@pytest.mark.parametrize("name", NAMES)
def test_a_phone_s_picture_has_no_scale(
    tmp_path: Path, grey: NDArray[np.uint8], name: str
) -> None:
    exif = tags(6, dpi=72)
    exif[0x010F], exif[0x0110] = "a maker", "a model"
    exif.get_ifd(0x8769)[0x920A] = 5.7
    file = saved(Image.fromarray(grey), tmp_path / name, exif=exif)
    with pytest.raises(DrawingFault, match=r"states 72 dpi, but a camera took it"):
        Drawing.open(file)
    assert raster.read(file, coloured=False).camera == ("a maker", "a model", None)


@pytest.mark.parametrize("name", NAMES)
def test_a_placeholder_is_no_resolution(
    tmp_path: Path, grey: NDArray[np.uint8], name: str
) -> None:
    file = saved(Image.fromarray(grey), tmp_path / name, exif=tags(dpi=72))
    with pytest.raises(DrawingFault, match=r"states 72 dpi, which is what programs write"):
        Drawing.open(file)
    Drawing.open(file, dpi=72)  # the advice works
    bare = saved(Image.fromarray(grey), tmp_path / f"bare-{name}")
    with pytest.raises(DrawingFault, match=r"states no resolution; give --dpi 300"):
        Drawing.open(bare)


@pytest.mark.parametrize("name", NAMES)
def test_a_damaged_picture_is_refused(
    tmp_path: Path, grey: NDArray[np.uint8], name: str
) -> None:
    whole = saved(Image.fromarray(grey), tmp_path / name).read_bytes()
    for kept in (60, len(whole) // 2, len(whole) - 20):
        (tmp_path / f"cut-{name}").write_bytes(whole[:kept])
        with pytest.raises(DrawingFault, match=r"is (not an image|a damaged image)"):
            raster.read(tmp_path / f"cut-{name}", coloured=False)


@pytest.mark.parametrize("name", ["a.webp", "a.png"])
def test_the_first_of_moving_pictures_is_taken_and_it_is_said(
    tmp_path: Path, grey: NDArray[np.uint8], name: str
) -> None:
    first, second = Image.fromarray(grey).convert("RGB"), Image.new("RGB", grey.shape[::-1])
    first.save(tmp_path / name, save_all=True, append_images=[second])
    scan = raster.read(tmp_path / name, coloured=False)
    assert scan.notes[0].endswith("has 2 pages; page 1 is taken; for another one give --page")
    assert raster.read(tmp_path / name, coloured=False, page=2).pixels.max() < 5


def test_a_heic_of_several_pictures_opens_at_its_own(tmp_path: Path) -> None:
    import pillow_heif

    shades = [Image.new("RGB", (64, 64), (level,) * 3) for level in (40, 120, 200)]
    pillow_heif.register_heif_opener()
    shades[0].save(
        tmp_path / "a.heic", save_all=True, append_images=shades[1:], primary_index=1
    )
    scan = raster.read(tmp_path / "a.heic", coloured=False)
    assert (scan.page, scan.pages) == (2, 3) and abs(float(scan.pixels.mean()) - 120) < 3
    last = raster.read(tmp_path / "a.heic", coloured=False, page=3)
    assert abs(float(last.pixels.mean()) - 200) < 3


def test_a_plain_picture_loads_no_reader_of_other_formats(
    tmp_path: Path, grey: NDArray[np.uint8]
) -> None:
    Image.fromarray(grey).save(tmp_path / "a.png", dpi=(300, 300))
    code = (
        "import sys; from morfax.tracer.drawing.drawing import Drawing; "
        f"Drawing.open({str(tmp_path / 'a.png')!r}); "
        "print(sorted({'pypdfium2', 'pillow_heif', 'ezdxf', 'svgelements'} & set(sys.modules)))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "[]"


def test_a_tiff_that_is_not_packed_is_read_as_it_stands(
    grey: NDArray[np.uint8], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Pillow copies it five times, as long as all else takes on empty paper. One that is turned is set
    upright, one that is cut off is refused.
    """
    from PIL.TiffImagePlugin import TiffImageFile

    loaded = list[str]()
    load = TiffImageFile.load
    monkeypatch.setattr(TiffImageFile, "load", lambda self: loaded.append("") or load(self))
    plain, turned, mirrored = (tmp_path / f"{name}.tif" for name in ("a", "b", "c"))
    Image.fromarray(grey).save(plain)
    assert np.array_equal(raster.read(plain, coloured=False).pixels, grey) and not loaded
    Image.fromarray(grey).save(turned, tiffinfo={0x112: 3})
    assert np.array_equal(raster.read(turned, coloured=False).pixels, grey[::-1, ::-1])
    # the bits of each byte from the right
    Image.fromarray(grey).save(mirrored, tiffinfo={0x10A: 2})
    bits = np.packbits(np.unpackbits(grey[..., None], axis=2)[..., ::-1], axis=2)[..., 0]
    assert np.array_equal(raster.read(mirrored, coloured=False).pixels, bits)
    assert loaded
    plain.write_bytes(plain.read_bytes()[:-1])
    with pytest.raises(DrawingFault, match="damaged"):
        raster.read(plain, coloured=False)
