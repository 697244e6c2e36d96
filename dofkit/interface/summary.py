"""What many scenes say together: how many, how sure, right by their own answers or not, and how long it took."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

from dofkit.base.verdicts import VERDICTS
from dofkit.base.wording import many

if TYPE_CHECKING:
    from dofkit.report import Report

#: What ``--fail-on`` may name.
FAILURES = ("inconsistent", "infeasible", "redundant", "undecided")
_MOST_NAMED, _SLOWEST = 8, 3
#: The widths of a line a scene: a name is given no more room than this; the labels; a verdict.
WIDEST_NAME, LABELS, VERDICT = 40, len("non-holonomic, scleronomic"), len("undecided")


def headline(widest: int) -> str:
    """What stands above a line a scene; ``f``: degrees of freedom, ``v``: independent velocities."""
    return f"{'scene':<{min(widest, WIDEST_NAME)}}  {'f':>3} {'v':>3}  {'the system':<{LABELS}}  verdict"


def outcome_of(report: Report) -> dict[str, Any]:
    """What is counted of a report; ``is`` holds those of `FAILURES` that it is."""
    found = {
        "inconsistent": report.consistent is False,
        "infeasible": report.feasible is False,
        "redundant": bool(report.redundant or report.redundant_equations),
        "undecided": report.verdict == "undecided",
    }
    return {"scene": report.scene, "verdict": report.verdict, "is": [name for name in FAILURES if found[name]]}


class Counted(NamedTuple):
    """One file: what was found of it (None: it could not be read), and the seconds that it took, loading included."""

    outcome: Mapping[str, Any] | None
    seconds: float


@dataclass
class Summary:
    """The files so far."""

    counted: list[Counted] = field(default_factory=list)

    def add(self, outcome: Mapping[str, Any] | None, seconds: float) -> None:
        """Count one file."""
        self.counted.append(Counted(outcome, seconds))

    def fails(self, on: tuple[str, ...]) -> bool:
        """Is a scene one of these?"""
        return any(name in outcome["is"] for outcome in self._outcomes for name in on)

    @property
    def _outcomes(self) -> list[Mapping[str, Any]]:
        return [one.outcome for one in self.counted if one.outcome is not None]

    def lines(self) -> Iterator[str]:
        """What is said of them all."""
        outcomes = self._outcomes
        by_verdict = Counter(outcome["verdict"] for outcome in outcomes)
        said = [f"{by_verdict[verdict]} {verdict}" for verdict in VERDICTS if by_verdict[verdict]]
        unread = len(self.counted) - len(outcomes)
        if unread:
            said.append(f"{unread} could not be read")
        seconds = sum(one.seconds for one in self.counted)
        yield f"{many(len(self.counted), 'scene')} in {_seconds(seconds)}: {', '.join(said)}"
        yield from self._expected()
        are = Counter(name for outcome in outcomes for name in outcome["is"] if name != "undecided")
        if are:
            yield f"  {', '.join(f'{are[name]} {name}' for name in FAILURES if are[name])}"
        by_time = [
            (one.outcome.get("seconds", one.seconds), one.outcome["scene"]) for one in self.counted if one.outcome
        ]
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
