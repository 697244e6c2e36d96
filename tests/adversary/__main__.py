"""The command: hunt for so many minutes, print what is found and a summary by kind."""

from __future__ import annotations

import argparse

from .hunt import Hunt
from .registry import KINDS, OPEN
from .running import SECONDS


def chosen(wanted: str, *, with_open: bool) -> list[str]:
    """The kinds, or families, of a list of names; all of those that are not open where none is given."""
    names = [name for name in wanted.split(",") if name]
    kinds = [kind for kind in KINDS if not names or kind in names or kind.split("/")[0] in names]
    return kinds if names or with_open else [kind for kind in kinds if kind not in OPEN]


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m tests.adversary", description="Hunt for a wrong answer.")
    parser.add_argument("--minutes", type=float, default=10.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kinds", default="", help="kinds or families, with commas between them; default: all")
    parser.add_argument("--seconds", type=float, default=SECONDS, help="processor time for one scene")
    parser.add_argument(
        "--with-open", action="store_true", help="count those that are known to be answered wrongly too"
    )
    parser.add_argument("--certificates", action="store_true", help="ask the checker as well")
    parser.add_argument("--no-files", action="store_true", help="keep nothing as a test")
    given = parser.parse_args()
    hunt = Hunt(chosen(given.kinds, with_open=given.with_open), given.seconds, not given.no_files, given.certificates)
    try:
        hunt.run(given.minutes, given.seed)
    finally:
        print(hunt.summary())


if __name__ == "__main__":
    main()
