"""Evidence that relations cannot be met."""

from __future__ import annotations

from dofkit.methods.certificates.room import Room, Told


def conflicting(room: Room, path: str) -> Told | None:
    """Not looked for yet."""
    return None
