"""The same scene in other coordinates: what is true of it does not change. The rewriting is SymPy's."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from typing import Any

import sympy as sp

from dofkit.benchmark.trials.construction import KnownScene, scene_of

x, y, z, w, theta, phi, psi, r, a = sp.symbols("x y z w theta phi psi r a", real=True)
Form = Mapping[sp.Symbol, sp.Expr]


@dataclass(frozen=True)
class Base:
    """Finite relations and one-forms in coordinates of which the first two are lengths in a plane.

    ``holonomic`` by row, forms only; ``proper``: neither none nor all of what the forms span integrates.
    """

    name: str
    coordinates: tuple[sp.Symbol, ...]
    dof: int
    velocity_dof: int
    finite: tuple[sp.Expr, ...] = ()
    forms: tuple[Form, ...] = ()
    holonomic: tuple[bool | None, ...] = field(default=())
    proper: bool = False


def _bases() -> list[Base]:
    cos, sin = sp.cos, sp.sin
    turn_x = {theta: cos(phi), psi: sin(theta) * sin(phi)}
    turn_y = {theta: sin(phi), psi: -sin(theta) * cos(phi)}
    one = sp.Integer(1)
    return [
        Base("upright disc", (x, y, theta, phi), 4, 2, (),
             ({x: one, phi: -2 * cos(theta)}, {y: one, phi: -2 * sin(theta)}), (False, False)),
        Base("sleigh", (x, y, theta), 3, 2, (), ({x: sin(theta), y: -cos(theta)},), (False,)),
        Base("Heisenberg", (x, y, z), 3, 2, (), ({x: y, y: -x, z: one},), (False,)),
        Base("contact", (x, y, z), 3, 2, (), ({x: -y, z: one},), (False,)),
        Base("d(xyz)", (x, y, z), 2, 2, (), ({x: y * z, y: x * z, z: x * y},), (True,)),
        Base("an angle", (x, y, z), 2, 2, (), ({x: -y, y: x},), (True,)),
        Base("y d(xy)", (x, y, z), 2, 2, (), ({x: y**2, y: x * y},), (True,)),
        Base("d(x/z + y)", (x, y, z), 2, 2, (), ({x: z, y: z**2, z: -x},), (True,)),
        Base("Engel", (x, y, z, w), 4, 2, (), ({z: one, x: -y}, {y: one, x: -w}), (False, False)),
        Base("two of one curvature", (x, y, z, w), 3, 2, (),
             ({z: one, x: -y}, {w: one, x: -2 * y}), (False, False), True),
        Base("two integrable ones", (x, y, z, w), 2, 2, (), ({z: one, x: -x}, {w: one, y: -y}), (True, True)),
        Base("a contact form on a cylinder", (x, y, z, w), 3, 2, (x**2 + y**2 - 1,), ({z: one, w: -y},), (False,)),
        Base("an exact form on a cylinder", (x, y, z), 1, 1, (x**2 + y**2 - 1,), ({z: one, x: -y},), (True,)),
        Base("a sphere", (x, y, z), 2, 2, (x**2 + y**2 + z**2 - 4,)),
        Base("a line as two planes", (x, y, z), 1, 1, (x + y - 2 * z - 1, x - y + z - 2)),
        Base("rolling ball", (x, y, theta, phi, psi), 5, 3, (),
             ({x: one} | {q: -v for q, v in turn_y.items()}, {y: one} | turn_x), (False, False)),
    ]  # fmt: skip


# The rewritings

Map = Mapping[sp.Symbol, sp.Expr]
Rewriting = Callable[[Base], Base | None]


def pulled_back(base: Base, mapping: Map, coordinates: Sequence[sp.Symbol]) -> Base:
    """x_i = X_i(u): g(X(u)) and sum_j (sum_i a_i dX_i/du_j) du_j."""
    of = {q: mapping.get(q, q) for q in base.coordinates}
    forms = []
    for form in base.forms:
        inside = {q: v.subs(of, simultaneous=True) for q, v in form.items()}
        forms.append({u: sum(v * sp.diff(of[q], u) for q, v in inside.items()) for u in coordinates})
    finite = tuple(g.subs(of, simultaneous=True) for g in base.finite)
    return replace(base, coordinates=tuple(coordinates), finite=finite, forms=tuple(forms))


def _by(make: Callable[[Base], Map]) -> Rewriting:
    return lambda base: pulled_back(base, make(base), base.coordinates)


def _scaled(power: int) -> Rewriting:
    factor = sp.Integer(10) ** power
    return _by(lambda base: {q: factor * q for q in base.coordinates if q in (x, y)})


def polar(base: Base) -> Base:
    """x = r cos a, y = r sin a."""
    return pulled_back(base, {x: r * sp.cos(a), y: r * sp.sin(a)}, (r, a, *base.coordinates[2:]))


def permuted(base: Base) -> Base:
    """Coordinates and rows the other way round."""
    order = tuple(reversed(base.forms)), tuple(reversed(base.holonomic))
    return replace(base, coordinates=tuple(reversed(base.coordinates)), forms=order[0], holonomic=order[1])


def with_factors(base: Base) -> Base | None:
    """Every row times a function without zeros."""
    if not base.forms:
        return replace(base, finite=tuple((2 + sp.sin(x)) * g for g in base.finite))
    factors = (1 + x**2, sp.exp(y), 3 - sp.cos(x))
    forms = tuple({q: f * v for q, v in form.items()} for f, form in zip(factors, base.forms, strict=False))
    return replace(base, forms=forms)


def mixed(base: Base) -> Base | None:
    """Two rows by a matrix of functions with determinant 1 + x^2 y^2: each mixes what integrates with what does not."""
    if len(base.forms) != 2:
        return None
    first, second = base.forms
    forms = tuple(
        {q: p * first.get(q, 0) + s * second.get(q, 0) for q in base.coordinates} for p, s in ((1, x * y), (-x * y, 1))
    )
    return replace(base, forms=forms, holonomic=(None, None) if base.proper else base.holonomic)


REWRITINGS: Mapping[str, Rewriting] = {
    "as it is": lambda base: base,
    "turned by 3, 4, 5": _by(lambda _: {x: (3 * x - 4 * y) / 5, y: (4 * x + 3 * y) / 5}),
    "turned by 20, 99, 101": _by(lambda _: {x: (20 * x - 99 * y) / 101, y: (99 * x + 20 * y) / 101}),
    "scaled by 10^-6": _scaled(-6),
    "scaled by 10^6": _scaled(6),
    "scaled by 10^9": _scaled(9),
    "one scaled by 10^-9": _by(lambda _: {y: y / sp.Integer(10) ** 9}),
    "moved by 10^6": _by(lambda _: {x: x + 10**6, y: y - 10**6}),
    "polar": polar,
    "x + y^2": _by(lambda _: {x: x + y**2}),
    "y + x^3/3": _by(lambda _: {y: y + x**3 / 3}),
    "sheared by an exponential": _by(lambda _: {x: x + sp.exp(y)}),
    "a hyperbolic sine": _by(lambda _: {y: sp.sinh(y)}),
    "in another order": permuted,
    "rows with factors": with_factors,
    "rows mixed": mixed,
    "turned, then x + y^2": lambda base: pulled_back(
        pulled_back(base, {x: (3 * x - 4 * y) / 5, y: (4 * x + 3 * y) / 5}, base.coordinates),
        {x: x + y**2},
        base.coordinates,
    ),
    "mixed, then scaled": lambda base: None if (found := mixed(base)) is None else _scaled(-6)(found),
}


@cache
def _rewritten_truths() -> tuple[KnownScene, ...]:
    found = []
    for base in _bases():
        for name, rewriting in REWRITINGS.items():
            made = rewriting(base)
            if made is not None:
                found.append(_trial(made, name))
    return tuple(found)


def other_coordinates() -> Iterator[KnownScene]:
    """Every base in every other way of writing it."""
    return iter(_rewritten_truths())


def _trial(base: Base, how: str) -> KnownScene:
    texts = [f"{g} = 0" for g in base.finite]
    for form in base.forms:
        terms = [f"({v}) d{q}" for q, v in form.items() if v != 0]
        texts.append(f"{' + '.join(terms)} = 0")
    truth: dict[str, Any] = {"consistent": True, "dof": base.dof, "velocity_dof": base.velocity_dof}
    first = len(base.finite) + 1
    truth |= {f"c{i}.holonomic": True for i in range(1, first)}
    truth |= {f"c{first + i}.holonomic": h for i, h in enumerate(base.holonomic) if h is not None}
    made = scene_of([str(q) for q in base.coordinates], *texts)
    return KnownScene(made, truth, name=f"{base.name}, {how}", group=base.name)
