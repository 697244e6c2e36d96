"""Drawings near singular poses, of any size, anywhere, rounded, with a tolerance or without."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from dofkit.benchmark.trials import sweeps
from dofkit.benchmark.trials.construction import KnownScene, known_scene

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


def _freedom(case: KnownScene, because: str, traits: Sequence[str]) -> KnownScene:
    """The degree of freedom alone, which is known at every step."""
    return known_scene(case.name, case.scene, because, traits, swept=case.swept, dof=case.dof)


def near_singular(quick: bool) -> Iterator[KnownScene]:
    """At singular poses, and 10^-1 ... 10^-12 beside them."""
    for number, case in enumerate(sweeps.steps()):
        if number % 17 if quick else case.swept["step"] not in STEPS:
            continue
        trait = "near-singular" if case.swept["step"] else POSES.get(case.group, "shaky")
        yield _freedom(case, DERIVED, (trait,))


def scaled(quick: bool) -> Iterator[KnownScene]:
    """A million times larger and smaller, and far away."""
    for number, case in enumerate(sweeps.sizes()):
        if number % (31 if quick else 3):
            continue
        traits = (_moved(case), "near-singular" if case.swept["step"] else POSES.get(case.group, "shaky"))
        yield _freedom(case, DERIVED, traits)


def rounded(quick: bool) -> Iterator[KnownScene]:
    """Rounded drawings: exact as they are written."""
    for number, case in enumerate(sweeps.roundings()):
        if quick and number % 11:
            continue
        because = "the exact rank of what is written: independent bars stay so, and nothing is singular there"
        yield _freedom(case, because, ("rounded",))


def measured(quick: bool) -> Iterator[KnownScene]:
    """Rounded drawings with a tolerance: true is what was rounded."""
    for number, case in enumerate(sweeps.measured()):
        if quick and number % 11:
            continue
        yield _freedom(case, DERIVED, ("measured",))


def measured_elsewhere(quick: bool) -> Iterator[KnownScene]:
    """Exact drawings with a tolerance, of any size and anywhere."""
    for number, case in enumerate(sweeps.measured_elsewhere()):
        if number % (29 if quick else 3):
            continue
        traits = ("measured", _moved(case))
        yield _freedom(case, DERIVED, traits)


def _moved(case: KnownScene) -> str:
    """What is the matter with where it is, and how large."""
    return "offset" if case.swept["offset"] else "scale" if case.swept["scale"] != 1 else "special-position"


FAMILIES = {
    "near singular": near_singular,
    "size and place": scaled,
    "rounded": rounded,
    "rounded, with tolerance": measured,
    "size and place, with tolerance": measured_elsewhere,
}
