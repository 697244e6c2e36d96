"""Drawings near singular poses, of any size, anywhere, rounded, with a tolerance or without."""

from __future__ import annotations

from collections.abc import Iterator

from dofkit.benchmark.trials import sweeps
from dofkit.benchmark.trials.making import asked
from dofkit.benchmark.trials.trial import Trial

#: What a singular pose is like, by mechanism.
POSES = {
    "four-bar at its change point": "crossing",
    "flat parallelogram": "crossing",
    "third crank longer": "special-position",
    "third crank aside": "special-position",
    "three on a rod, plane": "shaky",
    "three on a rod, space": "shaky",
    **dict.fromkeys((jointed.name for jointed in sweeps.JOINTED), "overconstrained"),
}
#: The steps that are taken.
STEPS = (0, 1e-1, 1e-3, 1e-6, 1e-12)
DERIVED = "derived by hand at the singular pose and beside it, for every step"


def near_singular(quick: bool) -> Iterator[Trial]:
    """At singular poses, and 10^-1 ... 10^-12 beside them."""
    for number, case in enumerate(sweeps.steps()):
        if number % 17 if quick else case.swept["step"] not in STEPS:
            continue
        trait = "near-singular" if case.swept["step"] else POSES.get(case.known.group, "shaky")
        yield from asked("near singular", case.known, DERIVED, (trait,), swept=case.swept, questions=("dof",))


def scaled(quick: bool) -> Iterator[Trial]:
    """A million times larger and smaller, and far away."""
    for number, case in enumerate(sweeps.sizes()):
        if number % (31 if quick else 3):
            continue
        traits = (_moved(case), "near-singular" if case.swept["step"] else POSES.get(case.known.group, "shaky"))
        yield from asked("size and place", case.known, DERIVED, traits, swept=case.swept, questions=("dof",))


def rounded(quick: bool) -> Iterator[Trial]:
    """Rounded drawings: exact as they are written."""
    for number, case in enumerate(sweeps.roundings()):
        if quick and number % 11:
            continue
        because = "the exact rank of what is written: independent bars stay so, and nothing is singular there"
        yield from asked("rounded", case.known, because, ("rounded",), swept=case.swept, questions=("dof",))


def measured(quick: bool) -> Iterator[Trial]:
    """Rounded drawings with a tolerance: true is what was rounded."""
    for number, case in enumerate(sweeps.measured()):
        if quick and number % 11:
            continue
        yield from asked(
            "rounded, with tolerance", case.known, DERIVED, ("measured",), swept=case.swept, questions=("dof",)
        )


def measured_elsewhere(quick: bool) -> Iterator[Trial]:
    """Exact drawings with a tolerance, of any size and anywhere."""
    for number, case in enumerate(sweeps.measured_elsewhere()):
        if number % (29 if quick else 3):
            continue
        traits = ("measured", _moved(case))
        yield from asked(
            "size and place, with tolerance", case.known, DERIVED, traits, swept=case.swept, questions=("dof",)
        )


def _moved(case: sweeps.Case) -> str:
    """What is the matter with where it is, and how large."""
    return "offset" if case.swept["offset"] else "scale" if case.swept["scale"] != 1 else "special-position"


FAMILIES = {
    "near singular": near_singular,
    "size and place": scaled,
    "rounded": rounded,
    "rounded, with tolerance": measured,
    "size and place, with tolerance": measured_elsewhere,
}
