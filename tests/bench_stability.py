"""Of every sweep and every way to count freedom: how often right, undecided and wrong. Run it; it is no test.

python tests/bench_stability.py
"""

from __future__ import annotations

import random
import time
from collections import Counter
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

from shared.trials import Outcome, outcome

import dofkit
from dofkit.benchmark.trials.frameworks import Framework
from dofkit.benchmark.trials.random_systems import graph
from dofkit.benchmark.trials.sweeps import SWEEPS, Case, drawn_case
from dofkit.methods.names import MethodName

#: Primes of 3, 6, 14 and 61 bits.
PRIMES = (7, 61, 16381, 2**61 - 1)
#: Random frameworks.
RANDOM = 200
Way = Callable[[Case], Outcome | None]


def counted(how: Callable[[Framework], int]) -> Way:
    """A way that gives one number, taken for the dof; only for bars, and where the dof is known."""

    def judged(case: Case) -> Outcome | None:
        if case.framework is None or "dof" not in case.known.truth:
            return None
        try:
            return "right" if max(0, how(case.framework)) == case.known.truth["dof"] else "wrong"
        except ValueError:
            return "undecided"

    return judged


def classified(method: MethodName = "auto", **more: Any) -> Way:
    """Everything that `dofkit.classify` tells, held against everything that is known."""

    def judged(case: Case) -> Outcome:
        scene = dofkit.load({**case.known.scene, **more})
        return outcome(case.known, dofkit.classify(scene, method=method))

    return judged


WAYS: dict[str, Way] = {
    "count (f = n - k)": counted(Framework.by_count),
    "graph (general position)": counted(Framework.by_graph),
    "rank at the positions, exact": counted(Framework.by_rank),
    "singular values, 1e-9": counted(Framework.by_svd),
    "singular values, 1e-3": counted(lambda drawn: drawn.by_svd(1e-3)),
    **{f"rank modulo {p}": counted(partial(Framework.by_prime, p=p)) for p in PRIMES},
    "classify, field alone": classified("field"),
    "classify, balls alone": classified("balls"),
    "classify": classified(),
}


def anywhere() -> Iterator[Case]:
    """Random bars in general position: the truth is the rank over the rationals."""
    rng = random.Random("bars")
    for number in range(RANDOM):
        drawn = graph(rng, rng.choice((1, 2, 3)), rng.randrange(3, 12))
        first = drawn.by_rank()
        yield drawn_case(f"bars {number}", drawn, (first, first))


def main() -> None:
    """Print everything."""
    for name, sweep in {"random bars in general position": anywhere, **SWEEPS}.items():
        cases = list(sweep())
        print(f"{f'{name} ({len(cases)} scenes)':<44} {'right':>8} {'undecided':>10} {'wrong':>8} {'seconds':>9}")
        for way, judge in WAYS.items():
            start = time.process_time()
            found = Counter(told for told in map(judge, cases) if told is not None)
            shares = [f"{found[kind] / max(1, found.total()):.1%}" for kind in ("right", "undecided", "wrong")]
            spent = time.process_time() - start
            print(f"  {way:<42} {shares[0]:>8} {shares[1]:>10} {shares[2]:>8} {spent:9.1f}")


if __name__ == "__main__":
    main()
