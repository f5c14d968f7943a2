"""A batch on a Dask cluster whose workers are threads here: results sent back, or written at an address."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import pytest

pytest.importorskip(
    "distributed", reason="dask is not installed: pip install 'morfax[cluster]'"
)

from morfax.batch import manifest
from morfax.batch.job import BatchJob
from morfax.motion.faults import FileFault
from tests.batch.test_batch import here, scans

__all__ = ["here", "scans"]
pytestmark = pytest.mark.filterwarnings("ignore")  # of dask's own threads and sockets
ENDINGS = {"small.png": "done", "large.png": "done", "empty.png": "fault", "bad.png": "fault"}


@pytest.fixture(scope="module")
def scheduler() -> Iterator[str]:
    """The address of a cluster of two threads."""
    from distributed import LocalCluster

    with LocalCluster(
        n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None
    ) as cluster:
        yield cluster.scheduler_address


@pytest.mark.parametrize("at_address", [False, True])
def test_results_are_the_same_as_here(scans: Path, scheduler: str, at_address: bool) -> None:
    drawings = f"file://{scans}" if at_address else "scans"
    out = f"file://{Path.cwd() / 'shared' / 'out'}" if at_address else "out"
    job = BatchJob(drawings, out, scheduler=scheduler)
    rows = {Path(row.file).name: row for row in job.rows()}
    assert {name: row.ending for name, row in rows.items()} == ENDINGS
    where = Path("shared/out" if at_address else "out")
    for row in rows.values():
        figures = json.loads((where / row.folder / "figures.json").read_text())
        assert figures["ending"] == row.ending and figures["file"] == row.file
        assert row.ending != "done" or (where / row.folder / "program.ngc").exists()
    assert len(list(manifest.rows(Path("out")))) == 4
    again = list(job.rows())
    assert [row.kept for row in again] == [True] * 4
    assert len(list(manifest.rows(Path("out")))) == 4


def test_a_drawing_that_cannot_be_read_costs_no_other(scans: Path, scheduler: str) -> None:
    for file in scans.rglob("*.png"):
        file.unlink()
    (scans / "a.png").symlink_to("nowhere.png")
    (scans / "b.png").write_text("no picture")
    rows = {
        Path(row.file).name: row for row in BatchJob("scans", "out", scheduler=scheduler).rows()
    }
    assert (
        rows["a.png"].fault
        == "cannot read scans/a.png: No such file or directory; check the name"
    )
    assert "scans/b.png" in rows["b.png"].fault and "/tmp" not in rows["b.png"].fault


def test_an_address_that_nothing_knows_is_a_fault(scans: Path, scheduler: str) -> None:
    with pytest.raises(FileFault, match="give an address that fsspec knows here"):
        list(BatchJob("nothing://a/scans", "out", scheduler=scheduler).rows())


def test_a_scheduler_that_is_not_there_is_told(
    scans: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from morfax.batch import cluster

    monkeypatch.setattr(cluster, "CONNECT_S", 0.5)
    job = BatchJob("scans", "out", scheduler="tcp://127.0.0.1:9")
    with pytest.raises(FileFault, match=r"no scheduler answers at tcp://127\.0\.0\.1:9"):
        list(job.rows())
