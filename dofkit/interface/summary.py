"""What many scenes say together: how many, how sure, right by their own answers or not, and how long it took."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from typing import Any

from dofkit.base.verdicts import VERDICTS
from dofkit.base.wording import many
from dofkit.interface.outcome import FAILURES

_MOST_NAMED, _SLOWEST = 8, 3


class Summary:
    """The files so far: of each what was found (None: it could not be read), and its seconds, loading included."""

    def __init__(self) -> None:
        self._counted: list[tuple[Mapping[str, Any] | None, float]] = []

    def add(self, outcome: Mapping[str, Any] | None, seconds: float) -> None:
        """Count one file."""
        self._counted.append((outcome, seconds))

    def fails(self, on: tuple[str, ...]) -> bool:
        """Is a scene one of these?"""
        return any(name in outcome["is"] for outcome in self._outcomes for name in on)

    @property
    def _outcomes(self) -> list[Mapping[str, Any]]:
        return [outcome for outcome, _ in self._counted if outcome is not None]

    def lines(self) -> Iterator[str]:
        """What is said of them all."""
        outcomes = self._outcomes
        by_verdict = Counter(outcome["verdict"] for outcome in outcomes)
        said = [f"{by_verdict[verdict]} {verdict}" for verdict in VERDICTS if by_verdict[verdict]]
        unread = len(self._counted) - len(outcomes)
        if unread:
            said.append(f"{unread} could not be read")
        seconds = sum(seconds for _, seconds in self._counted)
        yield f"{many(len(self._counted), 'scene')} in {_seconds(seconds)}: {', '.join(said)}"
        yield from self._expected()
        are = Counter(name for outcome in outcomes for name in outcome["is"] if name != "undecided")
        if are:
            yield f"  {', '.join(f'{are[name]} {name}' for name in FAILURES if are[name])}"
        by_time = [(found.get("seconds", took), found["scene"]) for found, took in self._counted if found]
        slowest = sorted(by_time, key=lambda pair: -pair[0])[:_SLOWEST]
        if slowest:
            yield f"  slowest: {', '.join(f'{scene} {_seconds(seconds)}' for seconds, scene in slowest)}"

    def _expected(self) -> Iterator[str]:
        """How many are as they expect, and which are not."""
        asked = [outcome for outcome in self._outcomes if outcome.get("expects")]
        wrong = [outcome["scene"] for outcome in asked if outcome["unmet"]]
        if asked:
            yield f"  right by their own answers: {len(asked) - len(wrong)} of {len(asked)}"
        if wrong:
            more = f" and {len(wrong) - _MOST_NAMED} more" if len(wrong) > _MOST_NAMED else ""
            yield f"  otherwise than they expect: {', '.join(wrong[:_MOST_NAMED])}{more}"


def _seconds(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds >= 100 else f"{seconds:.2g} s" if seconds < 1 else f"{seconds:.1f} s"
