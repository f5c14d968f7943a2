"""Many drawings: `python -m benchmarks batch [N]`, pages of 1 Mpx.

against a shell loop     drawings a minute of `morfax batch` over those of `morfax trace`, one after the other
busy                     share of the cores' time in which a drawing was worked on
killed -9                one worker in five drawings: rows, whole folders, drawings that are there twice
parent                   largest memory of the parent's own objects for a million rows (simulated)
cluster                  the same drawings on a Dask cluster of two processes, one of which is killed
"""

from __future__ import annotations

import contextlib
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
import tracemalloc
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np
from PIL import Image

from benchmarks.rows import Row, tell
from morfax.batch.crew import Crew, WorkerLimits
from morfax.batch.job import BatchJob, cores
from morfax.batch.manifest import Manifest
from morfax.batch.one import TraceOne, left_out
from morfax.batch.order import Order
from morfax.batch.results import FIGURES, LocalResults
from morfax.batch.row import BatchRow
from morfax.batch.tally import Tally

SIDE_PX, DPI = 1000, 300
IN_LOOP = 4  # drawings of the shell loop
MILLION = 1_000_000
RUN = "import sys; from morfax.console.cli import main; sys.exit(main(sys.argv[1:]))"


def main(words: list[str]) -> None:
    """Print the table."""
    count = int(words[0]) if words else 60
    with tempfile.TemporaryDirectory() as here:
        scans = Path(here, "scans")
        drawn(scans, count)
        list(BatchJob(str(scans), f"{here}/warm", pattern="0000.png").rows())
        tell(f"{count} drawings and a loop", against_a_loop(scans, Path(here)))
        tell("workers killed with -9", killed(scans, Path(here)))
        tell("the parent", million(Path(here)))
        tell("a cluster, one worker of two killed", on_a_cluster(scans, Path(here)))


def drawn(folder: Path, count: int) -> None:
    """Pages of 1 Mpx with one wavy ring each."""
    folder.mkdir()
    angle = np.linspace(0, 2 * np.pi, 721)
    for k in range(count):
        chance = np.random.default_rng(k)
        grey = np.full((SIDE_PX, SIDE_PX), 245, np.uint8)
        radius = 300 + 20 * chance.uniform(0.5, 1) * np.sin(chance.integers(2, 6) * angle)
        places = 500 + np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)
        cv2.polylines(
            grey, [np.rint(places * 16).astype(np.int32)], True, 30, 7, cv2.LINE_AA, 4
        )
        noisy = np.clip(grey + chance.normal(0, 3, grey.shape), 0, 255).astype(np.uint8)
        Image.fromarray(noisy).save(folder / f"{k:04d}.png", dpi=(DPI, DPI))


def against_a_loop(scans: Path, here: Path) -> list[Row]:
    """A batch against a loop of commands."""
    files = sorted(scans.iterdir())
    began_s = time.monotonic()
    for file in files[:IN_LOOP]:
        outputs = ["-o", here / "loop.ngc", "--path", here / "loop.csv"]
        subprocess.run([sys.executable, "-c", RUN, "trace", file, *outputs, "-q"], check=True)
    loop_per_minute = 60 * IN_LOOP / (time.monotonic() - began_s)
    tally = Tally(len(files), cores())
    for one in BatchJob(str(scans), str(here / "out"), limits=WorkerLimits(cores())).rows():
        tally.count(one)
    speed, busy = tally.per_minute, 100 * float(tally.figures()["busy_share"])
    return [
        Row("one after the other by a shell", loop_per_minute, "a minute"),
        Row("batch (8 asked)", speed, "a minute", speed / loop_per_minute, "the loop"),
        Row("share of the cores busy (80 asked)", busy, "%"),
    ]


def killed(scans: Path, here: Path) -> list[Row]:
    """Workers killed at random, one for every five drawings."""
    names, results = sorted(map(str, scans.iterdir())), LocalResults(here / "killed")
    results.out.mkdir()
    order, chance, rows = Order(), random.Random(1), list[BatchRow]()
    crew = Crew(TraceOne(order, results), WorkerLimits(cores()), results.clear)
    shots = len(names) // 5
    for one in crew.rows(names):
        rows.append(left_out(order, one, results) if one.ending == "killed" else one)
        if crew.killed < shots:
            time.sleep(chance.uniform(0, 0.05))
            with contextlib.suppress(ProcessLookupError):
                os.kill(chance.choice(crew.processes), signal.SIGKILL)
    folders = [folder for folder in results.out.iterdir() if folder.name != ".unfinished"]
    once = sum(n == 1 for n in Counter(one.file for one in rows).values())
    halves = sum(not (folder / FIGURES).exists() for folder in folders)
    return [
        Row("workers killed", crew.killed, "workers"),
        Row("done or marked, once", once, "drawings"),
        Row("marked: two workers died over them", sum(not r.is_well for r in rows), "drawings"),
        Row("whole folders", len(folders) - halves, "folders"),
        Row("half folders", halves, "folders"),
    ]


def million(here: Path) -> list[Row]:
    """Rows of a million drawings through tally and manifest."""

    def simulated() -> Iterator[BatchRow]:
        for k in range(MILLION):
            yield BatchRow(
                f"{k}.png", "done", f"{k:064x}", f"{k}", seconds=0.1, kept=k % 2 == 0
            )

    (here / "million").mkdir()
    tally = Tally(MILLION)
    tracemalloc.start()
    with Manifest(here / "million") as manifest:
        for one in simulated():
            tally.count(one)
            manifest.append(one)
    held = tracemalloc.get_traced_memory()[1] / 1e6
    tracemalloc.stop()
    return [Row("held for a million rows", held, "MB")]


def on_a_cluster(scans: Path, here: Path) -> list[Row]:
    """Two local workers of Dask, one of which is killed."""
    from distributed import LocalCluster

    here_rows = BatchJob(str(scans), str(here / "out")).rows()
    wanted = {one.file: one.hash for one in here_rows}
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        pids = [worker.pid for worker in cluster.workers.values()]
        job = BatchJob(str(scans), str(here / "dask"), scheduler=cluster.scheduler_address)
        rows = []
        for one in job.rows():
            rows.append(one)
            if len(rows) == 3:
                os.kill(pids[0], signal.SIGKILL)
    same = {one.file: one.hash for one in rows if one.is_well} == wanted
    return [
        Row("done or marked, once", len({one.file for one in rows}), "drawings"),
        Row("as on this computer", float(same), "(1: yes)"),
    ]
