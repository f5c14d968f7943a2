"""The file of corrections: read, written, edited as a text; each mistake pointed at."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.motion.faults import CardFault
from morfax.tracer.corrections import beside
from morfax.tracer.corrections.correction_file import (
    as_toml,
    parse_corrections,
    with_added,
    without,
    write_text,
)
from morfax.tracer.corrections.corrections import (
    INKED,
    KINDS,
    TURNS,
    Correction,
    Corrections,
    PictureFile,
    Place,
    Span,
)

PICTURE = PictureFile("scan.png", 1200, 800, "0" * 64)
HUNDREDTHS = st.integers(0, 120_000).map(lambda n: n / 100)  # of a pixel: as a file has them
PLACES = st.builds(Place, HUNDREDTHS, HUNDREDTHS, st.sampled_from(["px", "mm"]))


@st.composite
def corrections(draw: st.DrawFn) -> Correction:
    """Any correction that can be served."""
    kind = draw(st.sampled_from(KINDS))
    fewest = 3 if kind == "rub-area" else 1
    count = draw(st.integers(fewest, 5)) if kind in INKED else 1
    places = tuple(draw(PLACES) for _ in range(count))
    width = Span(draw(HUNDREDTHS.filter(bool))) if kind in ("rub", "bridge") else None
    come = draw(PLACES) if kind in TURNS and draw(st.booleans()) else None
    way = draw(st.sampled_from([None, "cw", "ccw"])) if kind == "start" else None
    why = draw(st.text(st.characters(categories=["L", "P", "S", "Zs", "N"]), max_size=20))
    return Correction(kind, places, width, come, way, why if why.isprintable() else "")


@given(st.lists(corrections(), max_size=4))
def test_what_is_written_is_read_as_the_same(each: list[Correction]) -> None:
    said = Corrections(tuple(each), PICTURE)
    assert parse_corrections(as_toml(said)) == said


@given(st.lists(corrections(), min_size=1, max_size=4), st.data())
def test_one_is_added_at_the_end_and_taken_away_by_its_number(
    each: list[Correction], data: st.DataObject
) -> None:
    text = as_toml(Corrections(tuple(each[:-1]), PICTURE))
    more = with_added(text, (each[-1],), PICTURE)
    assert list(parse_corrections(more).each) == each
    number = data.draw(st.integers(1, len(each)))
    left = [one for n, one in enumerate(each, 1) if n != number]
    assert list(parse_corrections(without(more, (number,))).each) == left


def test_remarks_stay_with_the_entry_below_them() -> None:
    text = """# my scan
[[correction]]
do = "rub"    # with care
at = "1px,2px"

# the pen skipped here
[[correction]]
do = "bridge"
at = ["1px,2px", "3px,4px"]
"""
    assert without(text, (2,)) == text[: text.index("\n# the pen")]
    assert without(text, (1,)).startswith(
        '# the pen skipped here\n[[correction]]\ndo = "bridge"'
    )
    added = with_added(text, (Correction("stop", (Place(5, 6),)),), PICTURE)
    assert added.startswith(text)


@pytest.mark.parametrize(
    ("entry", "told"),
    [
        (
            'do = "paint"\nat = "1px,2px"',
            'line 2: correction[1].do holds "paint"; it may hold "rub"',
        ),
        ('do = "rub"', "it must hold at"),
        ('do = "rub"\nat = "1px"', 'it may hold a place such as "345px,210px"'),
        ('do = "rub"\nat = "1px,2mm"', "it may hold a place"),
        ('do = "rub"\nat = [1, 2]', "it may hold a place"),
        ('do = "rub"\nat = "1px,2px"\nwidth = "0mm"', "a width above zero"),
        ('do = "rub"\nat = "nanpx,2px"', "it may hold a place"),
        ('do = "stop"\nat = ["1px,2px", "3px,4px"]', "stop has 2 places; it takes one place"),
        ('do = "rub-area"\nat = ["1px,2px", "3px,4px"]', "it takes 3 to 2000 places"),
        ('do = "stop"\nat = "1px,2px"\nwidth = "3mm"', "line 4: correction[1].width"),
        ('do = "stop"\nat = "1px,2px"\nfrom = "3px,2px"', "stop takes no from"),
        ('do = "rub"\nat = "1px,2px"\ndirection = "cw"', "rub takes no direction"),
        ('do = "rub"\nat = "1px,2px"\nwhy = "a\\nb"', "a text of one line"),
        ('do = "rub"\nat = "1px,2px"\ndepth = "3mm"', "there is no such field"),
    ],
)
def test_a_mistake_is_pointed_at(entry: str, told: str) -> None:
    with pytest.raises(CardFault) as fault:
        parse_corrections(f"[[correction]]\n{entry}\n", "scan.morfax.toml")
    assert str(fault.value).startswith("scan.morfax.toml, line ")
    assert told in str(fault.value)
    assert "\n" not in str(fault.value)


def test_a_file_is_written_whole_or_not_at_all(tmp_path: Path) -> None:
    file = beside(tmp_path / "my scan.v2.png")
    assert file.name == "my scan.v2.morfax.toml"
    write_text(file, as_toml(Corrections((), PICTURE)))
    before = file.read_bytes()
    with pytest.raises(CardFault):
        write_text(file, "[[correction]]\n")
    assert file.read_bytes() == before
    assert [each.name for each in tmp_path.iterdir()] == [file.name]
