"""Fuzz readers of text, programs and drawings, with no tool: `python -m fuzz.readers [SECONDS] [TARGET ...]`.

Each target has a whole, right file; an input is that file after one to eight changes: bytes, stretches,
digits, tokens that readers stumble over. Every input must be read or end in a fault of the domain. Another
exception, or 2 s of the processor, is kept in `fuzz-TARGET-NUMBER` and told; the exit code is then 1.
"""

from __future__ import annotations

import random
import signal
import sys
import tempfile
import time
import warnings
from pathlib import Path
from types import FrameType

from fuzz.targets import Target, targets
from morfax.motion.faults import Fault

SLOW_S = 2.0
TOKENS = (
    b"nan", b"inf", b"-1", b"0", b"1e308", b"1e-308", b"9" * 40, b"\x00", b"\xff\xfe", b"\r\n", b",", b'"',
    b"[[", b"]]", b"=", b"#", b"(", b")", b"G2 X1 Y1 R0", b"{", b"}", b"-0.0", b"%", b"M2", b"crc32",
)  # fmt: skip
# a file here is in memory: on a disk each input costs some ms
IN_MEMORY = Path("/dev/shm")


def changed(right: bytes, chance: random.Random) -> bytes:
    """A file after some changes."""
    data = bytearray(right)
    for _ in range(chance.choice((1, 1, 1, 2, 3, 8))):
        at, other = chance.randrange(len(data) + 1), chance.randrange(len(data) + 1)
        way = chance.randrange(6)
        if way == 0 and at < len(data):
            data[at] = chance.randrange(256)
        elif way == 1:
            data[at:at] = chance.choice(TOKENS)
        elif way == 2:
            del data[at : at + chance.choice((1, 2, 8, 40))]
        elif way == 3:
            data[at:at] = data[other : other + chance.choice((1, 8, 80))]
        elif way == 4 and at < len(data) and chr(data[at]).isdigit():
            data[at] = ord(chance.choice("0123456789.-e"))
        elif way == 5:
            data[at : at + chance.randrange(1, 8)] = chance.choice(TOKENS)
    return bytes(data)


def fuzz(name: str, target: Target, seconds: float, seed: int) -> tuple[int, int]:
    """Try a target for some seconds; how many inputs, and how many of them failed."""
    (right, read), chance = target, random.Random(seed)
    read(right)
    tried = failed = 0
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        data, tried = changed(right, chance), tried + 1
        signal.setitimer(signal.ITIMER_VIRTUAL, SLOW_S)
        try:
            read(data)
        except Fault:
            pass
        except Exception as error:
            failed += 1
            Path(f"fuzz-{name}-{tried}").write_bytes(data)
            print(f"{name} {tried}: {error!r}", flush=True)
    signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)
    return tried, failed


def too_slow(number: int, frame: FrameType | None) -> None:
    """End the reading of an input that has taken too long."""
    raise TimeoutError(f"{SLOW_S:g} s of the processor")


def main(words: list[str]) -> int:
    """Fuzz all targets, or those that are named, each for some seconds."""
    seconds = float(words[0]) if words else 10.0
    warnings.simplefilter("ignore")
    signal.signal(signal.SIGVTALRM, too_slow)
    bad = 0
    where = IN_MEMORY if IN_MEMORY.is_dir() else None
    with tempfile.TemporaryDirectory(dir=where) as folder:
        for name, target in targets(Path(folder)):
            if words[1:] and name not in words[1:]:
                continue
            tried, failed = fuzz(name, target, seconds, seed=round(time.time()))
            print(f"{name}: {tried} inputs, {failed} failed", flush=True)
            bad += failed
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
