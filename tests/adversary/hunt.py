"""Cases of every kind, one after the other, until the time is up."""

from __future__ import annotations

import random
import time
from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, field

from .findings import fails_alike, faults, kept, outcome
from .registry import KINDS, OPEN
from .running import answered_apart
from .trial import TRIES, Trial, any_trial, length, made, shrunk

#: Cases that are tried at most to shrink one whose time was overrun: each may take as long.
LATE_TRIES = 6


@dataclass
class Hunt:
    """``seconds``: of processor time for a scene. ``counts``: outcomes by kind; ``seen``: a kind's fields found
    wrong. ``certificates``: whether the checker is asked too, and what it says counts."""

    kinds: Sequence[str]
    seconds: float
    write: bool = True
    certificates: bool = False
    counts: dict[str, Counter[str]] = field(default_factory=lambda: defaultdict(Counter))
    seen: set[tuple[str, frozenset[str]]] = field(default_factory=set)

    def run(self, minutes: float, seed: int) -> None:
        """Until so many minutes have passed; a kind after the other, so that each has its share."""
        rng, until = random.Random(seed), time.monotonic() + 60 * minutes
        while time.monotonic() < until:
            for kind in self.kinds:
                if time.monotonic() >= until:
                    break
                self.look(any_trial(rng, [kind]))

    def look(self, trial: Trial) -> None:
        """Answer a trial, and shrink and keep what is wrong in a way that was not seen yet."""
        case = made(trial)
        answer = answered_apart(case.scene, self.seconds, certificates=self.certificates)
        result = outcome(case, answer)
        self.counts[trial.kind][result] += 1
        told = faults(case, answer)
        fields = frozenset(told)
        if not told:
            return
        known = trial.kind in OPEN
        if known or (trial.kind, fields) in self.seen:
            return
        self.seen.add((trial.kind, fields))
        print(f"{result:<8} {trial}: {told}", flush=True)
        self._shrink(trial, fields)

    def _shrink(self, trial: Trial, fields: frozenset[str]) -> None:
        tries = LATE_TRIES if "late" in fields else TRIES
        least = shrunk(
            trial, lambda other: fails_alike(other, fields, self.seconds, certificates=self.certificates), tries
        )
        case = made(least)
        told = faults(case, answered_apart(case.scene, self.seconds, certificates=self.certificates))
        where = f", kept in {kept(least, told).name}" if self.write else ""
        truth = {key: case.truth.get(key) for key in told}
        print(f"  smallest, {length(case.scene)} characters{where}: {least}", flush=True)
        print(f"  {case.scene}\n  told {told}, truth {truth}", flush=True)

    def summary(self) -> str:
        """Outcomes by kind."""
        outcomes = ("right", "undecided", "refused", "wrong", "failed", "late", "killed")
        lines = [f"{'kind':<34}" + "".join(f"{name:>10}" for name in outcomes)]
        for kind in [*(kind for kind in KINDS if kind in self.counts)]:
            counts = self.counts[kind]
            mark = "  (open)" if kind in OPEN else ""
            lines.append(f"{kind:<34}" + "".join(f"{counts[name] or '.':>10}" for name in outcomes) + mark)
        total = sum(self.counts.values(), Counter[str]())
        lines.append(f"{'all':<34}" + "".join(f"{total[name] or '.':>10}" for name in outcomes))
        return "\n".join(lines)
