"""Large sheets: read by rows, kept in tiles, and made behind the aperture where the head goes.

A small drawing is taken for a large one: what is asked of A0 is asked of the code, not of the computer.
"""

import io
import warnings
from contextlib import suppress
from pathlib import Path

import cv2
import numpy as np
import pytest
import tifffile
from PIL import Image

from morfax.motion.faults import DrawingFault
from morfax.motion.motion import thin
from morfax.motion.polyline import nearest_mm, with_places
from morfax.tracer.drawing import by_rows, deviation, large, memory, raster, tiff_rows
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.tiles import PAPER, TILE_PX, Tiles
from morfax.tracer.ink.left_out import ink_left
from morfax.tracer.program.trace import trace
from morfax.tracer.sensing import aperture, photocell

CAM = Path(__file__).parents[3] / "samples" / "cam.png"
UM = 1e-3  # mm
STEP = 1 / 200  # of darkness: a grey level of a usual scan
APERTURE_MM = 0.15
PACKED = ("tiff_lzw", "tiff_adobe_deflate", "packbits")


@pytest.fixture
def as_large(monkeypatch):
    """Every sheet is a large one."""
    monkeypatch.setattr(large, "LARGE_PX", 1)


@pytest.fixture(scope="module")
def cam():
    """The cam in tiles, and as a whole."""
    with pytest.MonkeyPatch.context() as patch:
        whole = Drawing.open(CAM)
        patch.setattr(large, "LARGE_PX", 1)
        return Drawing.open(CAM), whole


def _kept(drawing: Drawing) -> np.ndarray:
    """Mask of the pixels of which tiles are kept."""
    kept = np.kron(drawing.darkness.number != PAPER, np.ones((TILE_PX, TILE_PX), bool))
    return np.ascontiguousarray(kept[: drawing.darkness.shape[0], : drawing.darkness.shape[1]])


def _picture(mode: str) -> Image.Image:
    """Noise with 701 rows and 537 columns, of a mode of Pillow's."""
    levels = (
        np.random.default_rng(1).normal(200, 30, (701, 537, 3)).clip(0, 255).astype(np.uint8)
    )
    colours = Image.fromarray(levels)
    if mode == "P":
        return colours.quantize(17)
    return (
        colours.convert("L").point(lambda v: 255 * (v > 200)).convert("1")
        if mode == "1"
        else colours.convert(mode)
    )


def _by_rows(file: Path) -> np.ndarray | None:
    with file.open("rb") as stream, Image.open(stream) as image:
        rows = by_rows.rows_of(image, stream)
    return None if rows is None else np.asarray(rows)


def _as_a_whole(file: Path) -> np.ndarray:
    with Image.open(file) as image:
        return np.asarray(raster._grey(image))


@pytest.mark.parametrize("mode", ["L", "RGB", "1", "P"])
def test_a_png_is_the_same_by_rows(tmp_path, mode):
    file = tmp_path / "noise.png"
    _picture(mode).save(file)
    assert np.array_equal(_by_rows(file), _as_a_whole(file))


@pytest.mark.parametrize("mode", ["L", "RGB", "1", "P"])
@pytest.mark.parametrize("packed", [*PACKED, "group4"])
def test_a_tiff_of_strips_is_the_same_by_rows(tmp_path, mode, packed):
    if packed == "group4" and mode != "1":
        mode = "1"
    file = tmp_path / "noise.tif"
    _picture(mode).save(file, compression=packed, tiffinfo={tiff_rows.STRIP_ROWS: 16})
    assert np.array_equal(_by_rows(file), _as_a_whole(file))


@pytest.mark.parametrize("big", ["<", ">"])
@pytest.mark.parametrize("packed", [None, "zlib"])
def test_a_tiff_of_tiles_is_the_same_by_rows(tmp_path, big, packed):
    """Tiles at the right and at the bottom reach beyond the picture; numbers stand in either order."""
    file, levels = tmp_path / "noise.tif", np.asarray(_picture("L"))
    tifffile.imwrite(file, levels, tile=(128, 160), compression=packed, byteorder=big)
    assert np.array_equal(_by_rows(file), levels)


def test_a_tiff_that_is_not_packed_is_read_straight_from_its_file(tmp_path):
    file, levels = tmp_path / "noise.tif", np.asarray(_picture("L"))
    Image.fromarray(levels).save(file)
    with file.open("rb") as stream, Image.open(stream) as image:
        rows = by_rows.rows_of(image, stream)
    assert rows is not None
    assert Path(rows._file.name) == file
    assert np.array_equal(rows[100:140], levels[100:140])


@pytest.mark.parametrize("what", ["interlaced", "deep", "transparent", "jpeg"])
def test_what_cannot_be_read_by_rows_is_read_as_a_whole_and_told(tmp_path, as_large, what):
    levels = cv2.imread(str(CAM), cv2.IMREAD_GRAYSCALE)
    file = tmp_path / ("cam.jpg" if what == "jpeg" else "cam.png")
    if what == "deep":
        cv2.imwrite(str(file), levels.astype(np.uint16) * 257)
    elif what == "transparent":
        Image.fromarray(np.dstack([levels, np.full_like(levels, 255)]), "LA").save(file)
    else:
        Image.fromarray(levels).save(file)
    if what == "interlaced":
        content = bytearray(file.read_bytes())
        content[28] = 1  # the header says so
        with Image.open(file) as image:
            assert by_rows.rows_of(image, io.BytesIO(content)) is None
        return
    scan = raster.read(file, coloured=False)
    assert isinstance(scan.pixels, np.ndarray)
    assert any("cannot be read by rows" in note for note in scan.notes)


def test_a_file_that_ends_too_early_is_a_damaged_image(tmp_path, as_large):
    file = tmp_path / "cut.png"
    file.write_bytes(CAM.read_bytes()[: CAM.stat().st_size // 2])
    with pytest.raises(DrawingFault, match="damaged"):
        raster.read(file, coloured=False)


@pytest.mark.parametrize("tiled", [False, True])
def test_strips_or_tiles_without_a_height_are_not_read_by_rows(tmp_path, as_large, tiled):
    """Whoever states a height of zero rows gets a fault of the tree or the picture, and no division by it."""
    file, levels = tmp_path / "noise.tif", np.asarray(_picture("L"))
    kind = {"tile": (128, 160)} if tiled else {"rowsperstrip": 16}
    tifffile.imwrite(file, levels, compression="zlib", **kind)
    tag = tiff_rows.TILE_HEIGHT if tiled else tiff_rows.STRIP_ROWS
    with tifffile.TiffFile(file, mode="r+") as tiff:
        tiff.pages[0].tags[tag].overwrite(0)
    with suppress(DrawingFault):
        assert np.array_equal(raster.read(file, coloured=False).pixels, levels)


def test_parts_of_tiles_are_those_of_the_whole():
    whole = np.zeros((100, 150), np.float32)
    whole[40:60, 20:130] = np.random.default_rng(1).integers(1, 200, (20, 110)) / 200
    number = np.full((4, 5), PAPER, np.int32)
    number[1, :] = range(5)
    kept = np.zeros((5, TILE_PX, TILE_PX), np.uint8)
    for k in range(5):
        part = whole[32:64, 32 * k : 32 * k + 32] * 200
        kept[k, : part.shape[0], : part.shape[1]] = np.rint(part)
    tiles = Tiles(whole.shape, number, kept, 1 / 200)
    assert np.allclose(np.asarray(tiles), whole, atol=1e-6 * STEP)
    assert np.allclose(tiles[35:70, 11:140], whole[35:70, 11:140], atol=1e-6 * STEP)
    i, j = np.random.default_rng(2).integers(0, 100, (2, 500))
    assert np.allclose(tiles[i, j], whole[i, j], atol=1e-6 * STEP)
    assert np.allclose(
        tiles.between(i + 0.0, j - 0.5)[j > 0], 0.5 * (whole[i, j] + whole[i, j - 1])[j > 0]
    )
    assert tiles.darker_px(0.5) == np.count_nonzero(whole > 0.5)
    mean = whole[:98, :147].reshape(14, 7, 21, 7).mean(axis=(1, 3))
    assert np.allclose(tiles.shrunk(7), mean, atol=1e-3 * STEP)
    with pytest.raises(TypeError):
        tiles[::2]


def test_the_ink_in_tiles_is_that_of_the_whole_sheet(cam):
    """Within the rounding of a byte, and what that makes of the ink's contrast; where there are tiles."""
    tiled, whole = cam
    assert isinstance(tiled.darkness, Tiles)
    kept = _kept(tiled)
    off = np.abs(np.asarray(tiled.darkness) - np.maximum(whole.darkness, 0))
    assert off[kept].max() < 2 * STEP
    # what was left out is noise of the paper
    assert whole.darkness[~kept].max() < 1.1 * large.ABOVE_NOISE * whole.noise.paper
    assert kept.mean() < 0.5  # most of the sheet is paper
    assert tiled.ink_px == pytest.approx(whole.ink_px, rel=0.01)
    assert tiled.noise.paper == pytest.approx(whole.noise.paper, rel=0.2)
    # noise lighter than the paper is cut off: a twentieth of a pixel of width
    assert tiled.noise.width_mm == pytest.approx(
        whole.noise.width_mm, abs=0.05 * whole.pitch_mm
    )
    assert tiled.sheet.lengths_mm.max() == pytest.approx(
        whole.sheet.lengths_mm.max(), rel=0.002
    )


@pytest.mark.parametrize("spot_mm", [0.0, APERTURE_MM])
def test_cells_see_the_same_of_a_large_sheet(cam, spot_mm):
    """At places on the line and at its edges, and in a window; also behind a further spot."""
    tiled, whole = cam
    cells = [photocell.behind_aperture(drawing, spot_mm) for drawing in cam]
    places = whole.sheet.longest().middles_mm[::7]
    places = places + np.random.default_rng(1).uniform(-0.2, 0.2, places.shape)
    seen, wanted = (photocell.darkness_along(c, places) for c in cells)
    assert np.abs(seen - wanted).max() < 4 * STEP
    assert cells[0].shape == cells[1].shape
    # the spots reach 12 pixels; beyond the tiles there is noise that these have lost
    within = cv2.erode(_kept(tiled).view(np.uint8), np.ones((25, 25), np.uint8)).view(bool)
    part = 100, 420, 100, 900
    within = within[100:420, 100:900]
    corners = np.array([(0.0, 0.0), (whole.width_mm, whole.height_mm)])
    for one, other in (cells, [c.wider(3.0, corners, 0.0) for c in cells]):
        assert np.abs(one.window(*part) - other.window(*part))[within].max() < 4 * STEP
    assert whole.darkness[100:420, 100:900][within].max() > 0.9  # ink is among them


def test_made_tiles_give_way_to_new_ones(cam, monkeypatch):
    """With room for three tiles the cells see what they see with room for all."""
    tiled, _ = cam
    places = tiled.sheet.longest().middles_mm[::3]
    with_room = photocell.darkness_along(photocell.behind_aperture(tiled, APERTURE_MM), places)
    monkeypatch.setattr(aperture, "ROOM", 3)
    cells = photocell.behind_aperture(tiled, APERTURE_MM)
    assert len(cells.tiles.made) == 3
    assert np.array_equal(photocell.darkness_along(cells, places), with_room)


def test_the_head_follows_a_large_sheet_as_any_other(cam):
    runs = []
    for drawing in cam:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            followed = trace(drawing)
        assert followed.ending == "closed"
        runs.append(thin(followed).runs()[0])
    off_mm = nearest_mm(runs[0], with_places(runs[1], 0.5 * UM))
    assert np.sqrt(np.mean(off_mm**2)) < 1 * UM  # the path's own thinning is 0.2 um
    assert off_mm.max() < 5 * UM


def test_all_of_the_ink_of_a_large_sheet_is_that_of_the_whole(cam):
    """Softened strip by strip: pixels differ only where a byte's step decides at the level of ink."""
    tiled, whole = (ink_left(drawing.sheet).ink for drawing in cam)
    soft = cv2.GaussianBlur(cam[1].darkness, (0, 0), 0.7)
    differs = tiled != whole
    assert whole.any() and abs(soft[differs] - 0.5).max(initial=0.0) < STEP


def test_the_ink_across_a_path_is_read_from_tiles(cam):
    places = np.array(
        [[20.0, 20.0], [21.0, 20.0], [300.0, 20.0]]
    )  # the last is beyond the sheet
    across = np.linspace(-1.0, 1.0, 9)
    seen = [deviation.darkness_across(each, places, np.zeros(3), across) for each in cam]
    np.testing.assert_allclose(seen[0], seen[1], atol=STEP)


def test_ink_that_does_not_fit_into_memory_is_told_before_it_is_kept(as_large, monkeypatch):
    """Asked are the tiles with ink alone: the cam has them on a small part of its sheet."""
    monkeypatch.setattr(memory, "SMALL_PX", 0)
    monkeypatch.setattr(memory, "free_bytes", lambda: 310_000_000)  # 10 MB beyond what is fixed
    assert Drawing.open(CAM).darkness.kept.nbytes * memory.PER_INKED_PIXEL < 10_000_000
    monkeypatch.setattr(memory, "free_bytes", lambda: 300_000_000)
    monkeypatch.setattr(large, "_kept", None)  # nothing is kept before it is asked
    with pytest.raises(
        DrawingFault, match=r"ink on or beside \d+ % of .* 0.3 GB are free; scan"
    ):
        Drawing.open(CAM)
