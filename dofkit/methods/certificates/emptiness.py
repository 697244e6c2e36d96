"""Evidence that relations cannot be met."""

from __future__ import annotations

from collections.abc import Iterator

from dofkit.methods.certificates.room import Room, Told


def conflicting(room: Room) -> Iterator[Told]:
    """Not looked for yet."""
    yield from ()
