"""What the checker cannot read or does not accept."""

from __future__ import annotations


class CheckError(ValueError):
    """A text, a scene or a certificate that cannot be read: nothing about it is verified."""


def refuse(when: object, why: str) -> None:
    """`CheckError` where something is so that must not be."""
    if when:
        raise CheckError(why)
