"""demo: the whole way on a sample that is part of morfax, in any folder, and never over somebody's files."""

from __future__ import annotations

from pathlib import Path

from tests.console.conftest import Morfax


def test_the_demo_goes_the_whole_way_and_says_what_to_try_next(
    morfax: Morfax, here: Path
) -> None:
    (here / "morfax-demo").mkdir()
    (here / "morfax-demo" / "program.png").write_text("dear to somebody")
    answer = morfax("demo", "--json")
    assert answer.exit_code == 0
    assert (here / "morfax-demo" / "program.png").read_text() == "dear to somebody"
    place = here / "morfax-demo-2"
    unpacked = {"program.png", "program.toml", "cam.png"}
    assert {file.name for file in place.iterdir()} == {*unpacked, "results"}
    assert (place / "results" / "program.png").read_bytes().startswith(b"\x89PNG")
    assert str(Path("morfax-demo-2", "results", "program.png")) in answer.err
    assert answer.figures["played_to_ink"]["rms_mm"] < 0.005
    # what it says to try next can be done
    lines = [line.strip().partition("    ")[0] for line in answer.err.splitlines()]
    record = next(line.split() for line in lines if line.startswith("morfax record"))
    assert morfax(*record[1:]).exit_code == 0
    assert (place / "program.ngc").exists()


def test_a_folder_that_holds_files_is_left_alone(morfax: Morfax, here: Path) -> None:
    (here / "dear.txt").write_text("dear to somebody")
    answer = morfax("demo", "-o", ".")
    assert answer.exit_code == 8 and "holds files already" in answer.fault
    answer = morfax("demo", "-o", "dear.txt")
    assert answer.exit_code == 8 and "cannot make the folder dear.txt" in answer.fault
    assert [file.name for file in here.iterdir()] == ["dear.txt"]
