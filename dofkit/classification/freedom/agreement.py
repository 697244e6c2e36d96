"""What both engines say of one block whose functions may be related in ways that the ring does not know.

Over GF(p) what is 0 may look like something else, and a nested root may stand for its conjugate; balls never take
non-zero for 0 unless it is smaller than their precision. Where both say the same it stands. Where they do not, the
balls' answer does if only numbers are in doubt; functions may be 0 in one region and not in another.
"""

from __future__ import annotations

from dataclasses import replace

from dofkit.base.verdicts import weakest
from dofkit.exact.matrices.sparse import echelon
from dofkit.relations.answer import Answer

DIFFER = "the functions or numbers that occur satisfy an identity that exact arithmetic modulo primes does not detect"
OPEN = "the functions or numbers that occur may satisfy an identity that exact arithmetic modulo primes does not detect"


def agreed(field: Answer, balls: Answer) -> Answer:
    """The answer of both engines, held against that of balls alone."""
    by_rank = field.consistent is False and bool(field.matrix)
    if field.consistent is not True and balls.consistent is not True and not by_rank:
        return field
    if balls.consistent is not True or balls.dof is None:
        return _open(field)
    if field.consistent is True and _same(field, balls):
        return field
    if field.doubt == "functions":
        return _open(field)
    return replace(numeric(balls), reasons=[*balls.reasons, DIFFER])


def numeric(balls: Answer) -> Answer:
    """What balls alone say, as a number that was measured: no proof of zero, no growth."""
    return replace(balls, verdict=weakest(balls.verdict, "numeric"), growth=None, derived=None)


def _same(a: Answer, b: Answer) -> bool:
    numbers = (a.dof, a.velocity_dof, a.instantaneous) == (b.dof, b.velocity_dof, b.instantaneous)
    labels = all(label.holonomic == b.labels[i].holonomic for i, label in a.labels.items() if i in b.labels)
    return (
        numbers
        and labels
        and a.hidden == b.hidden
        and echelon(a.matrix, a.modulus).independent == echelon(b.matrix, b.modulus).independent
    )


def _open(field: Answer) -> Answer:
    """Nothing is decided of a block that only one engine answers, and may mistake."""
    return Answer(
        None,
        verdict="undecided",
        reasons=[*field.reasons, OPEN],
        hidden=field.hidden,
        doubt=field.doubt,
        method=field.method,
    )
