"""How sure the answers of a report are, and by what, in words that a student reads."""

from __future__ import annotations

from collections.abc import Iterator

from dofkit.base.surface import handed_on
from dofkit.interface.show.sheet import Remark
from dofkit.report import FieldVerdict, Report

#: What is imported only where arguments are told.
_HEAVY = {"TABLE": "dofkit.classification.arguments"}
#: What a verdict means.
VERDICT_MEANS = {
    "proved": "follows by exact arithmetic that leaves no doubt",
    "probable": "exact arithmetic at random points; the chance of an error is bounded and tiny",
    "numeric": "measured or rounded numbers, told apart by a gap that is stated",
    "undecided": "not settled; the reason says why",
}
#: What the engines call their ways, and what that means. The first that fits is taken, so longer ones stand first.
_WAYS = (
    (
        "rank over GF(p) and balls",
        "the rank of the equations, found twice: in whole numbers modulo a large prime, where zero can be trusted, and "
        "with certified intervals about a real point, where non-zero can",
    ),
    (
        "rank over GF(p) at the given configuration",
        "the rank of the equations at the drawing, in whole numbers modulo a large prime",
    ),
    ("rank over GF(p)", "the rank of the equations, in whole numbers modulo a large prime"),
    (
        "Lie algebra along a curve over GF(p)",
        "the velocities that are allowed and their brackets (Frobenius), in whole numbers modulo a large prime",
    ),
    (
        "special cases by the zeros of minors and of curvature",
        "special cases where minors of the equations, or their curvature, are zero",
    ),
    ("graph of rigid links", "links as a graph, each counted where it is needed"),
)
#: What the model says of relations that hold no velocities, and what that means.
_NO_TEST = (
    "no integrability test where all relations are finite (d(dg) = 0)",
    "relations between coordinates are holonomic as they stand, so that nothing is tested for integrability",
)
#: Hypotheses shorter than this name other arguments only.
_TERSE = 14
_FIELDS = {
    "dof": "degrees of freedom",
    "velocity_dof": "velocities",
    "instantaneous_dof": "velocities to first order",
    "redundant_equations": "number of redundant equations",
    "redundancies": "redundant groups",
    "generalized_coordinates": "coordinates",
    "growth_vector": "growth vector",
    "integrable_part": "integrable part",
}


#: Before each thing that a model has and its scene leaves out.
LEFT_OUT = "; left out: "


def how_sure(report: Report, arguments: bool) -> list[Remark]:
    """What was computed with, in which way, what the verdicts mean; and by which ``arguments``."""
    model, *left_out = report.modelled.replace(*_NO_TEST).split(LEFT_OUT)
    told = [Remark(label, text) for label, text in (("the model", model), ("the way", way(report))) if text]
    told += [Remark("left out", text) for text in left_out]
    used = verdicts_of(report)
    told += [Remark(verdict, meaning) for verdict, meaning in VERDICT_MEANS.items() if verdict in used]
    return [*told, *_arguments(report)] if arguments else told


def verdicts_of(report: Report) -> set[str]:
    """The verdicts that occur."""
    return {report.verdict, *(e.verdict for e in report.constraints), *(case.verdict for case in report.special_cases)}


def way(report: Report) -> str:
    """How the answers were found."""
    if report.method == "count":
        return "by counting: each equation is independent of the others by itself"
    said = report.method
    for name, meaning in _WAYS:
        said = said.replace(name, meaning)
    return said.replace("over GF(p)", "modulo a large prime")


def _arguments(report: Report) -> Iterator[Remark]:
    """The fields that rest on one argument, and its hypotheses."""
    together: dict[str, list[str]] = {}
    for name, found in report.verdicts.items():
        if found.argument is not None:
            together.setdefault(found.argument, []).append(_FIELDS.get(name, name.replace("_", " ")))
    table = handed_on(__name__, _HEAVY, "TABLE") if together else {}
    for key, names in together.items():
        row = table[key]
        theorem = f" [{row.theorem}]" if row.theorem else ""
        because = "" if len(row.hypotheses) < _TERSE else f", because {row.hypotheses}"
        told = f"{row.claims}{because}".replace("over GF(p)", "modulo a large prime")
        yield Remark(", ".join(names), f"'{key}': {told}{theorem}")


def not_proved(report: Report) -> list[Remark]:
    """What is not proved: the fields of which the same is said in one line."""
    together: dict[str, list[str]] = {}
    for name, found in report.verdicts.items():
        if found.verdict != "proved":
            together.setdefault(f"{found.verdict}{_because(found)}", []).append(_FIELDS.get(name, name))
    return [Remark(", ".join(names), said) for said, names in together.items()]


def _because(found: FieldVerdict) -> str:
    """The argument, and the chance of an error or the gap."""
    if found.verdict == "undecided":
        return ""
    means = f"wrong with a chance below {found.bound}" if found.verdict == "probable" else f"by a gap of {found.bound}"
    where = (
        "" if found.about == "everywhere" else f", near the {'witness' if found.about == 'component' else found.about}"
    )
    return f" ({found.argument}; {means}{where})"
