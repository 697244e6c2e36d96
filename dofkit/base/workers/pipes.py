"""Messages over a pipe: eight bytes of length, then the message."""

from __future__ import annotations

import os
from struct import Struct

_LENGTH = Struct(">Q")
#: A longer message is none of ours.
LONGEST = 1 << 32
_PIECE = 1 << 20


def send(pipe: int, message: bytes) -> None:
    """Write one message. Raises OSError where nobody reads."""
    rest = memoryview(_LENGTH.pack(len(message)) + message)
    while rest:
        rest = rest[os.write(pipe, rest[:_PIECE]) :]


def receive(pipe: int) -> bytes | None:
    """Read one message; None where the other end is closed, or what comes is no message."""
    head = _exactly(pipe, _LENGTH.size)
    if head is None:
        return None
    (length,) = _LENGTH.unpack(head)
    return _exactly(pipe, length) if length <= LONGEST else None


def _exactly(pipe: int, length: int) -> bytes | None:
    parts = []
    while length:
        try:
            part = os.read(pipe, min(length, _PIECE))
        except OSError:
            return None
        if not part:
            return None
        parts.append(part)
        length -= len(part)
    return b"".join(parts)
