"""Angles of points on circles and spheres, which students use as coordinates where a scene has Cartesian ones."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

from dofkit.expressions.text import parse_expression, to_text
from dofkit.expressions.tree import Expr, coordinate, num, sqrt
from dofkit.homework.key.key import Key
from dofkit.homework.key.own_coordinates import implied
from dofkit.scene.constraints.distances import Link
from dofkit.scene.fields import as_written
from dofkit.scene.names import coordinate_table

#: Scenes of more particles get no angles: their constraints would take too long to search.
MOST_PARTICLES = 4
Place = tuple[Expr, ...]


def polar_angles(key: Key) -> dict[str, str]:
    """Return angle names with their definitions, for each particle that stays on a circle or a sphere.

    The angle of a circle is measured from the downward vertical where it is upright; on a sphere `theta` is the
    angle from the downward vertical and `phi` the azimuth.
    """
    particles = coordinate_table(key.scene).particles
    if not 0 < len(particles) <= MOST_PARTICLES or key.scene.dimension == 1:
        return {}
    places = {name: tuple(map(coordinate, names)) for name, names in particles.items()}
    taken = {*key.coordinates, *key.names.parameters, *key.names.functions}
    found: dict[str, str] = {}
    centre_of: dict[str, Place] = {}
    for name, place in places.items():
        others = [p for n, p in places.items() if n != name and centre_of.get(n) != place]
        for centre in [*_fixed_points(key), *others]:
            angles = _angles(key, [a - b for a, b in zip(place, centre, strict=True)], place)
            if angles:
                centre_of[name] = centre
                alone = len(places) == 1 and not angles.keys() & taken
                found |= {angle if alone else f"{angle}_{name}": text for angle, text in angles.items()}
                break
    return {angle: text for angle, text in found.items() if angle not in taken}


def _fixed_points(key: Key) -> list[Place]:
    """The origin, and the fixed points that links begin at."""
    ends = [end for c in key.scene.constraints if isinstance(c, Link) for end in c.between if isinstance(end, tuple)]
    told = [tuple(parse_expression(as_written(v), key.names) for v in end) for end in ends]
    return list(dict.fromkeys([tuple([num(0)] * key.scene.dimension), *told]))


def _radii(key: Key) -> list[str]:
    lengths = [as_written(c.length) for c in key.scene.constraints if isinstance(c, Link) and c.length is not None]
    return list(dict.fromkeys([*lengths, *(n for n, kind in key.scene.parameters.items() if kind == "positive")]))


def _angles(key: Key, offset: Sequence[Expr], place: Place) -> dict[str, str]:
    """The angles of a point at this offset from a fixed point or another particle; none where it is free to recede."""
    upright = _vertical(key, place)
    level = [n for n in range(len(place)) if n != upright]
    for pair in combinations(range(len(place)), 2):
        if _keeps_distance(key, [offset[n] for n in pair]):
            if upright in pair:
                (aside,) = (n for n in pair if n != upright)
                return {"theta": f"atan2({to_text(offset[aside])}, {to_text(-offset[upright])})"}
            return {"phi": f"atan2({to_text(offset[pair[1]])}, {to_text(offset[pair[0]])})"}
    if len(place) == 2 or not _keeps_distance(key, offset):
        return {}
    x, y = (offset[n] for n in level)
    away = sqrt(x**2 + y**2)
    return {
        "theta": f"atan2({to_text(away)}, {to_text(-offset[upright])})",
        "phi": f"atan2({to_text(y)}, {to_text(x)})",
    }


def _keeps_distance(key: Key, offset: Sequence[Expr]) -> bool:
    square = " + ".join(f"({to_text(e)})^2" for e in offset)
    return any(implied(key, f"{square} = ({radius})^2") for radius in _radii(key))


def _vertical(key: Key, place: Place) -> int:
    """The index of the coordinate along which gravity acts: the one in the potential energy, else the last."""
    potential = None if key.scene.energies is None else key.scene.energies.potential
    mentioned = set() if potential is None else parse_expression(potential, key.names).symbols
    found = [n for n, symbol in enumerate(place) if symbol in mentioned]
    return found[0] if len(found) == 1 else len(place) - 1
