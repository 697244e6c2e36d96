"""What many scenes say together: how many, how sure, right by their own answers or not, and how long it took."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from heapq import nlargest
from typing import Any

from dofkit.base.verdicts import VERDICTS
from dofkit.base.wording import many
from dofkit.interface.outcome import FAILURES

_MOST_NAMED, _SLOWEST = 8, 3
#: What a finding is called after a number of scenes, where its name alone would be misread.
_FINDINGS = {"redundant": "with redundant constraints"}


class Summary:
    """The files so far, counted: how many, how sure, how long; of all names only the few that are told are kept."""

    def __init__(self) -> None:
        self._files, self._unread, self._seconds = 0, 0, 0.0
        self._verdicts, self._are = Counter[str](), Counter[str]()
        self._asked, self._wrong = 0, 0
        self._named: list[str] = []
        self._slowest: list[tuple[float, int, str]] = []

    def add(self, outcome: Mapping[str, Any] | None, seconds: float) -> None:
        """Count one file: what was found (None: it could not be read), and its seconds, loading included."""
        self._files += 1
        self._seconds += seconds
        if outcome is None:
            self._unread += 1
            return
        self._verdicts[outcome["verdict"]] += 1
        self._are.update(outcome["is"])
        timed = (outcome.get("seconds", seconds), -self._files, outcome["scene"])
        self._slowest = nlargest(_SLOWEST, [*self._slowest, timed])
        if outcome.get("expects"):
            self._asked += 1
        if outcome.get("expects") and outcome["unmet"]:
            self._wrong += 1
            self._named += [outcome["scene"]] if self._wrong <= _MOST_NAMED else []

    def fails(self, on: tuple[str, ...]) -> bool:
        """Is a scene one of these?"""
        return any(self._are[name] for name in on)

    def lines(self) -> Iterator[str]:
        """What is said of them all."""
        said = [f"{self._verdicts[verdict]} {verdict}" for verdict in VERDICTS if self._verdicts[verdict]]
        if self._unread:
            said.append(f"{self._unread} could not be read")
        yield f"{many(self._files, 'scene')} in {_seconds(self._seconds)}: {', '.join(said)}"
        if self._asked:
            yield f"  agree with the answers in their files: {self._asked - self._wrong} of {self._asked}"
        if self._wrong:
            more = f" and {self._wrong - _MOST_NAMED} more" if self._wrong > _MOST_NAMED else ""
            yield f"  differ from the answers in their files: {', '.join(self._named)}{more}"
        are = [
            f"{self._are[name]} {_FINDINGS.get(name, name)}"
            for name in FAILURES
            if self._are[name] and name != "undecided"
        ]
        if are:
            yield f"  {', '.join(are)}"
        if self._slowest:
            yield f"  slowest: {', '.join(f'{scene} {_seconds(seconds)}' for seconds, _, scene in self._slowest)}"


def _seconds(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds >= 100 else f"{seconds:.2g} s" if seconds < 1 else f"{seconds:.1f} s"
