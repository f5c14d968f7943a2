"""Messages between the server and its worker: Python objects, each with its length before it.

Signals: a stream of bytes in or out; objects out or in. Both ends are one program: nobody else writes to
these pipes.
"""

from __future__ import annotations

import pickle
import struct
from typing import Any, BinaryIO

LENGTH = struct.Struct("<Q")


def packed(message: Any) -> bytes:
    """A message as bytes, with its length before it."""
    body = pickle.dumps(message, protocol=pickle.HIGHEST_PROTOCOL)
    return LENGTH.pack(len(body)) + body


def read_from(stream: BinaryIO) -> Any:
    """The next message; raises EOFError at the end."""
    head = stream.read(LENGTH.size)
    if len(head) < LENGTH.size:
        raise EOFError
    (length,) = LENGTH.unpack(head)
    body = stream.read(length)
    if len(body) < length:
        raise EOFError
    return pickle.loads(body)
