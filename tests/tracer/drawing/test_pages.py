"""Files of several pages: the page that is asked for; the first otherwise, and it is said."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from morfax.motion.faults import DrawingFault
from morfax.tracer.drawing import raster

SIZE = (60, 40)  # pixels


def pages(*levels: int) -> list[Image.Image]:
    """Pages of one grey level each."""
    return [Image.fromarray(np.full(SIZE[::-1], level, np.uint8)) for level in levels]


@pytest.fixture(params=["a.tif", "a.gif"])
def file(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    """A file of three pages, with levels 10, 20 and 30."""
    first, *rest = pages(10, 20, 30)
    file: Path = tmp_path / request.param
    first.save(file, save_all=True, append_images=rest)
    return file


@pytest.mark.parametrize("page", [1, 2, 3])
def test_the_page_that_is_asked_for_is_read(file: Path, page: int) -> None:
    scan = raster.read(file, coloured=False, page=page)
    assert (scan.page, scan.pages, scan.notes) == (page, 3, ())
    assert scan.pixels.max() == scan.pixels.min() == 10 * page


def test_without_a_page_the_first_is_read_and_it_is_said(file: Path) -> None:
    scan = raster.read(file, coloured=False)
    assert scan.pixels.max() == 10
    said = f"{file} has 3 pages; page 1 is taken; for another one give --page"
    assert scan.notes == (said,)


def test_a_page_that_is_not_there_is_told(file: Path, tmp_path: Path) -> None:
    with pytest.raises(DrawingFault, match=r"has no page 4; it has pages 1 to 3; give --page"):
        raster.read(file, coloured=False, page=4)
    pages(10)[0].save(tmp_path / "one.png")
    with pytest.raises(DrawingFault, match=r"has no page 2; it has one page"):
        raster.read(tmp_path / "one.png", coloured=False, page=2)


def test_each_page_of_a_tiff_has_its_own_resolution(tmp_path: Path) -> None:
    """The second page states none; the first one's is not its."""
    from PIL import TiffImagePlugin

    first, second = pages(10, 20)
    with TiffImagePlugin.AppendingTiffWriter(str(tmp_path / "a.tif"), True) as out:
        first.save(out, format="TIFF", dpi=(300, 300))
        out.newFrame()
        second.save(out, format="TIFF")
    assert raster.read(tmp_path / "a.tif", coloured=False, page=1).stated == ((300, 300), None)
    assert raster.read(tmp_path / "a.tif", coloured=False, page=2).stated is None


def test_a_camera_s_fields_are_read(tmp_path: Path) -> None:
    exif = Image.Exif()
    exif[0x010F], exif[0x0110] = "a maker", "a model"
    exif.get_ifd(0x8769).update({0x920A: 4.25, 0xA405: 26})
    pages(10)[0].save(tmp_path / "photo.jpg", exif=exif)
    camera = raster.read(tmp_path / "photo.jpg", coloured=False).camera
    assert camera == ("a maker", "a model", 26.0)
    pages(10)[0].save(tmp_path / "scan.jpg")
    assert raster.read(tmp_path / "scan.jpg", coloured=False).camera is None
