"""The command: answer cases of every kind for so many minutes; print what is wrong, and the outcomes of each kind."""

from __future__ import annotations

import argparse
import json
import random
import time
from collections import Counter, defaultdict

from dofkit.base.runs import Pool

from .registry import KINDS, OPEN, any_trial, made
from .running import SECONDS, answered_apart, faults, outcome


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m tests.adversary", description="Hunt for a wrong answer.")
    parser.add_argument("--minutes", type=float, default=10.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kinds", default="", help="kinds or families, with commas between them; default: all")
    parser.add_argument("--seconds", type=float, default=SECONDS, help="processor time for one scene")
    parser.add_argument("--certificates", action="store_true", help="ask the checker as well")
    options = parser.parse_args()
    names = [name for name in options.kinds.split(",") if name]
    kinds = [kind for kind in KINDS if not names or kind in names or kind.split("/")[0] in names]
    counts: dict[str, Counter[str]] = defaultdict(Counter)
    rng, until, seen = random.Random(options.seed), time.monotonic() + 60 * options.minutes, set()
    try:
        with Pool(1) as pool:
            while time.monotonic() < until:
                for kind in kinds if names else [kind for kind in kinds if kind not in OPEN]:
                    trial = any_trial(rng, kind)
                    case = made(trial)
                    answer = answered_apart(pool, case.scene, options.seconds, certificates=options.certificates)
                    counts[kind][outcome(case, answer)] += 1
                    wrong = faults(case, answer)
                    if wrong and (kind, *wrong) not in seen:
                        seen.add((kind, *wrong))
                        kept = {"kind": kind, "trial": str(trial), "scene": case.scene, "truth": case.truth}
                        text = json.dumps({**kept, "elsewhere": case.elsewhere, "told": wrong}, default=dict)
                        print(f"{trial}: {wrong}\n  {text}", flush=True)
    finally:
        for kind, row in counts.items():
            print(f"{kind:<34}", *(f"{name} {number}" for name, number in row.items()))


if __name__ == "__main__":
    main()
