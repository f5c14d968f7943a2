"""Uploads: what is no picture, too large, or named like a path, is refused in words and leaves nothing."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

import pytest
from starlette.testclient import TestClient

from morfax.motion.faults import DrawingFault
from morfax.panel import uploads
from morfax.panel.bench import Bench
from tests.panel.conftest import ORIGIN
from tests.panel.serving import SAMPLES


def sent(page: TestClient, name: str, content: bytes, **headers: str) -> tuple[int, str]:
    """Send a file; the status, and the words of a refusal."""
    answer = page.post(f"/upload/{name}", content=content, headers={**ORIGIN, **headers})
    return answer.status_code, answer.json().get("refused", "")


def left(bench: Bench) -> list[str]:
    """What is in the folder for drawings, hidden files too."""
    folder = bench.folder / "drawings"
    return sorted(file.name for file in folder.iterdir()) if folder.exists() else []


def test_a_picture_is_taken_in_and_can_be_opened(page: TestClient, bench: Bench) -> None:
    picture = (SAMPLES / "gear.png").read_bytes()
    assert sent(page, "gear.png", picture) == (200, "")
    assert sent(page, "gear.png", picture) == (200, "")  # nothing is written over
    assert left(bench) == ["gear-2.png", "gear.png"]
    seen = bench.history.revision
    answer = page.post(
        "/do", json={"do": "open", "drawing": "gear-2.png", "seen": seen}, headers=ORIGIN
    )
    assert (
        answer.status_code == 200 and bench.drawing == bench.folder / "drawings" / "gear-2.png"
    )


@pytest.mark.parametrize(
    "content", [b"", b"no picture", b"%!PS", b"\x89PNG\r\n\x1a\n", b"<svg onload='alert(1)'/>"]
)
def test_what_is_no_picture_is_refused(page: TestClient, bench: Bench, content: bytes) -> None:
    status, why = sent(page, "a.png", content)
    assert status == 409 and "no picture" in why
    assert not left(bench)


def test_a_stated_size_of_300_mb_is_refused_before_it_is_sent(
    page: TestClient, bench: Bench
) -> None:
    status, why = sent(page, "a.png", b"", **{"content-length": "300000000"})
    assert status == 409 and "larger than 256 MB" in why and not left(bench)


def test_a_stream_without_a_size_is_cut_off(
    monkeypatch: pytest.MonkeyPatch, page: TestClient, bench: Bench
) -> None:
    monkeypatch.setattr(uploads, "MOST_BYTES", 1000)

    def pieces():  # type: ignore[no-untyped-def]
        yield from (b"x" * 300 for _ in range(10))

    answer = page.post("/upload/a.png", content=pieces(), headers=ORIGIN)
    assert answer.status_code == 409 and not left(bench)


def test_a_picture_that_does_not_fit_the_memory_is_refused_unpacked(
    page: TestClient, bench: Bench
) -> None:
    def chunk(kind: bytes, data: bytes) -> bytes:
        return (
            struct.pack(">I", len(data))
            + kind
            + data
            + struct.pack(">I", zlib.crc32(kind + data))
        )

    # 4 million million pixels, stated in 45 bytes
    size = struct.pack(">IIBBBBB", 2_000_000, 2_000_000, 8, 0, 0, 0, 0)
    bomb = (
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", size) + chunk(b"IDAT", b"") + chunk(b"IEND", b"")
    )
    status, why = sent(page, "bomb.png", bomb)
    assert status == 409 and "GB of memory" in why and not left(bench)


@pytest.mark.parametrize(
    ("name", "kept"),
    [
        ("../../etc/passwd.png", "passwd.png"),
        ("C:\\scans\\part.PNG", "part.png"),
        ("<img src=x onerror=alert(1)>.png", "img-src-x-onerror-alert-1.png"),
        (".hidden.png", "hidden.png"),
        ("....png", "drawing.png"),
        ("Zeichnung größer.jpg", "Zeichnung-gr-er.jpg"),
        ("a" * 500 + ".tif", "a" * 60 + ".tif"),
        ("con\x00trol.png", "con-trol.png"),
    ],
)
def test_a_name_becomes_a_harmless_one(name: str, kept: str) -> None:
    assert uploads.harmless(name) == kept
    assert Path(kept).name == kept


@pytest.mark.parametrize("name", ["program.exe", "page.html", "drawing", "a.png/..", "a.svg"])
def test_a_name_of_no_picture_is_refused(name: str) -> None:
    with pytest.raises(DrawingFault, match="no picture by its name"):
        uploads.harmless(name)
