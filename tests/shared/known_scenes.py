"""Every scene of the catalog and of the tests, and its report, worked out once in a process.

Tests that have the parameter ``path`` run where the others of that scene do: see conftest.py.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Any
from zlib import crc32

import pytest

import dofkit
from dofkit.methods.certificates.certificate import entry_path
from dofkit.methods.certificates.lowering import with_certificate
from dofkit.report import FieldVerdict, Report
from dofkit.scene.scene import Scene

ROOT = Path(__file__).parents[2]
CATALOG = sorted((ROOT / "catalog").glob("*/*.yaml"))
#: Those of the tests, the bad ones left out.
OURS = [path for path in sorted((ROOT / "tests/scenes").glob("*/*.yaml")) if path.parent.name != "bad"]
SCENES = [*CATALOG, *OURS]
#: Hundreds of equations, of which a report takes seconds: it is read, and not answered again in other words.
LARGE = frozenset({"miura-ori-three-by-three"})
VARIED = [path for path in SCENES if path.stem not in LARGE]


def stem(path: Path) -> str:
    return path.stem


@cache
def scene_of(path: Path) -> Scene:
    return dofkit.load(path)


@cache
def report_of(path: Path) -> Report:
    return dofkit.classify(scene_of(path))


@cache
def strict_report_of(path: Path) -> Report:
    """Where what is proved was checked: with its certificate."""
    return with_certificate(scene_of(path), report_of(path), strict=True)


def verdicts_of(report: Report) -> Iterator[tuple[str, Any, FieldVerdict]]:
    """Every field with a verdict: its path, its value and how certain it is."""
    for start, model in (("", report), *((entry_path(entry), entry) for entry in report.constraints)):
        yield from ((f"{start}/{field}", getattr(model, field), verdict) for field, verdict in model.verdicts.items())


def few(what: str, paths: Sequence[Path], of: int, always: Collection[str] = ()) -> list[Any]:
    """One in so many of the scenes for ``what``, the same in every run, and ``always`` those; the others are swept."""
    chosen = dealt(what, paths, of)[0]
    return [pytest.param(path) if path in chosen or path.stem in always else swept(path) for path in paths]


def swept(*values: Any) -> Any:
    """A case for `pytest -m sweep`."""
    return pytest.param(*values, marks=pytest.mark.sweep)


def spread(cases: Iterable[Any], of: int = 3, *, several: bool = False) -> list[Any]:
    """One in so many of a test's cases, from the first on; the others are swept. ``several``: a case is a tuple."""
    params = (case if hasattr(case, "marks") else pytest.param(*(case if several else [case])) for case in cases)
    return [
        pytest.param(*param.values, marks=[*param.marks, pytest.mark.sweep], id=param.id) if k % of else param
        for k, param in enumerate(params)
    ]


def dealt(what: str, paths: Sequence[Path], hands: int) -> list[list[Path]]:
    """The scenes dealt out to so many variations of ``what``: each tries its own, the same in every run."""
    found: list[list[Path]] = [[] for _ in range(hands)]
    for path in paths:
        found[crc32(f"{what} {path.stem}".encode()) % hands].append(path)
    return found


#: Every scene of the catalog, and a third of those of the tests; the others are swept.
EVERY = [*CATALOG, *few("every scene", OURS, 3)]
#: Those of the tests, loops in space most of them, whose reports take longest.
SLOW = frozenset((Path(__file__).parent / "slow_scenes.txt").read_text(encoding="utf-8").split())
#: The same with every scene that is quick: what it expects was worked out by hand.
EXPECTED = [*CATALOG, *few("every scene", OURS, 3, {path.stem for path in OURS} - SLOW)]
