"""The pages: what they name is there. `make docs` checks the links between them."""

from __future__ import annotations

import re
import shlex
from itertools import pairwise
from pathlib import Path

import pytest

from tests.packaging.test_door import lines

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
NOT_RECIPES = [page for page in PAGES if page.parent.name != "recipes"]
NAMES = [str(page.relative_to(ROOT)) for page in PAGES]
FILE = re.compile(
    r"`((?:motion|tracer|recorder|player|jobs|reports|console|samples|docs|tests)/[\w/-]+\.\w+)`"
)
WRITES = ("-o", "--path", "--picture", "--following")


def plain(line: str) -> str:
    """A line with one blank between its words."""
    return " ".join(line.split())


@pytest.mark.parametrize("page", PAGES, ids=NAMES)
def test_every_file_that_a_page_names_is_there(page: Path) -> None:
    named = set(FILE.findall(page.read_text(encoding="utf-8")))
    assert {name for name in named if not (ROOT / name).exists()} == set()


def test_every_link_of_the_readme_leads_somewhere() -> None:
    links = re.findall(r"\]\(([^)#]+)", (ROOT / "README.md").read_text(encoding="utf-8"))
    assert links
    assert [link for link in links if not (ROOT / link).exists()] == []


def test_the_readme_s_pages_are_those_of_the_site() -> None:
    said = (ROOT / "mkdocs.yml").read_text(encoding="utf-8")
    in_nav = set(re.findall(r"[\w/-]+\.md", said))
    on_disk = {str(page.relative_to(ROOT / "docs")) for page in PAGES[1:]}
    assert in_nav == on_disk


@pytest.mark.parametrize("page", ["docs/reference/python.md", "docs/design.md"])
def test_the_lines_of_the_door_are_on_the_page(page: str) -> None:
    shown = [plain(line) for line in (ROOT / page).read_text(encoding="utf-8").splitlines()]
    wanted = [plain(line) for line in lines().splitlines()]
    first = shown.index("import morfax")
    assert shown[first : first + len(wanted)] == wanted


@pytest.mark.parametrize("page", NOT_RECIPES, ids=lambda page: str(page.relative_to(ROOT)))
def test_the_commands_of_a_page_can_be_typed_one_after_the_other(page: Path) -> None:
    """None writes over its own drawing, none makes up a tape that is there. test_recipes runs the recipes."""
    lines = re.findall(
        r"^ {4,}(morfax (?:trace|run) .*)$", page.read_text(encoding="utf-8"), re.M
    )
    made_up = list[str]()
    for line in lines:
        drawing, *words = shlex.split(line, comments=True)[2:]
        assert drawing not in words, line
        if "trace" in line and "-o" not in words and "--print-settings" not in words:
            made_up.append(drawing)
    assert len(made_up) == len(set(made_up))


@pytest.mark.parametrize(
    "name", ["alfred-herbert", "pratt-whitney", "sea", "side-by-side", "superior-electric"]
)
def test_a_system_s_page_makes_every_tape_and_path_that_its_commands_read(name: str) -> None:
    """Somebody who restores a control types them from the first to the last, with a scan of his own."""
    text = (ROOT / "docs" / "background" / f"{name}.md").read_text(encoding="utf-8")
    made = {"scan.png"}
    for line in re.findall(r"^ {4,}(morfax [a-z]+ \S*\..*)$", text, re.M):
        words = shlex.split(line, comments=True)[2:]
        files = [word for word in words if re.search(r"\.[a-z]+$", word)]
        written = [a for before, a in pairwise(words) if before in WRITES]
        assert set(files) - set(written) <= made, line
        made |= set(written)
