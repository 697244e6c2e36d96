"""Why a method fails, in a sentence."""

from __future__ import annotations


def explained(method: str, question: str, traits: tuple[str, ...], outcome: str, reason: str) -> str:
    """The sentence for a trial that a method does not answer rightly."""
    del question
    return reason or f"{method} is {outcome} where scenes are {traits[0] if traits else 'such'}"
