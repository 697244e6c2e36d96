"""Time in constraints: prescribed motions, drifts, and what differential constraints hide of it."""

from __future__ import annotations

from collections.abc import Iterator

from dofkit.benchmark.trials.construction import KnownScene, Line, known_scene, scene_of, tabled

TIMED: list[Line] = [
    ("a line that turns", "x y", ["y cos(t) = x sin(t)"], 1, [True], [], "a line", "rheonomic"),
    ("a circle that grows", "x y", ["x^2 + y^2 = (1 + t)^2"], 1, [True], [], "a circle", "rheonomic"),
    ("a circle under a factor of time", "x y", ["exp(t)*(x^2 + y^2 - 1) = 0"], 1, [True], [], "the factor is not 0",
     "rheonomic"),
    ("a place on a turning circle", "x y u", ["x = t cos(u)", "y = t sin(u)", "x^2 + y^2 = t^2"], 1, [True] * 3,
     ["c3"], "the third is implied by the other two", "hidden-relation"),
    ("another turning circle", "x y u", ["x = t cos(u)", "y = t sin(u)", "x^2 + y^2 = t"], -1, None, None,
     "t^2 = t is satisfied at two instants only", "contradiction"),
    ("two that run together", "x y", ["x = t", "y = t", "x = y"], 0, [True] * 3, ["c3"], "both are t", "redundant"),
    ("two that part", "x y", ["x = t", "y = 2 t", "x = y"], -1, None, None, "only at t = 0", "contradiction"),
    ("two that keep apart", "x y", ["x = t", "y = t + 1e-9", "x = y"], -1, None, None, "they never meet", "tiny-gap"),
    ("a drift", "x y z", ["dx = 2 dt"], 2, [True], [], "x - 2 t", "rheonomic"),
    ("a growing drift", "x y z", ["dx = t dt"], 2, [True], [], "x - t^2/2", "rheonomic"),
    ("growth", "x y z", ["dx = x dt"], 2, [True], [], "x e^-t", "rheonomic"),
    ("pursuit of a coordinate", "x y z", ["dx = y dt"], 3, [False], [], "a contact form in time", "rheonomic"),
    ("a turning edge", "x y", ["cos(t) dx + sin(t) dy = 0"], 2, [False], [], "closed at every moment, not with time",
     "rheonomic"),
    ("a turned edge", "x y", ["cos(1) dx + sin(1) dy = 0"], 1, [True], [], "constant coefficients", "integrable"),
    ("a growing edge", "x y", ["exp(t)*(dx + 2 y dy) = 0"], 1, [True], [], "x + y^2", "rheonomic"),
    ("two coordinates that drive each other", "x y", ["dx = y dt", "dy = x dt"], 0, [True, True], [],
     "two forms in (x, y, t) leave one direction", "together"),
    ("three that drive each other", "x y z", ["dx = y dt", "dy = z dt", "dz = x dt"], 0, [True] * 3, [],
     "three forms in (x, y, z, t)", "together"),
    ("a disc that turns with time", "x y ph", ["dx = cos(t) dph", "dy = sin(t) dph"], 3, [False, False], [],
     "time does what the heading does for the disc: brackets span (x, y, ph, t)", "rolling"),
    ("a disc that turns with time and rolls so", "x y ph", ["dx = cos(t) dph", "dy = sin(t) dph", "ph = t"], 0,
     [True] * 3, [], "one direction is left", "together"),
    ("a plane and its rate", "x y z", ["x + y = t", "xdot + ydot = z"], 1, [True, True], [], "z = 1 on it",
     "time-hidden"),
    ("two rates of one", "x y z", ["xdot + ydot = z", "xdot + ydot = z^2"], 1, [True, True], [],
     "z^2 = z: z is 0 or 1", "time-hidden"),
    ("two rates that differ", "x y z", ["xdot = 1", "xdot = 1 + 1e-12"], -1, None, None, "the rates differ",
     "tiny-gap"),
    ("two rates that meet", "x y", ["xdot = t", "xdot = 1"], -1, None, None, "only at t = 1", "contradiction"),
    ("rates that say where", "x y", ["xdot = y", "xdot = t"], 0, [True, True], [], "y = t, x = t^2/2 + C",
     "time-hidden"),
    ("a wheel on a running belt", "x ph", ["dx - dph = 2 dt"], 1, [True], [], "x - ph - 2 t", "rolling"),
    ("a sleigh on a running belt", "x y th", ["sin(th)*(dx - dt) = cos(th) dy"], 3, [False], [],
     "the sleigh in x - t", "non-holonomic"),
    ("an edge on a turning table", "x y", ["(1 + t^2)*(x dy - y dx) + (x^2 + y^2) dt = 0"], 1, [True], [],
     "the angle plus arc tan t", "rheonomic"),
    ("a radius that time drives", "x y z", ["x dx + y dy = z dt"], 3, [False], [], "d(x^2 + y^2)/2 = z dt with z free",
     "rheonomic"),
    ("the same with z held", "x y z", ["x dx + y dy = z dt", "z = 3"], 1, [True, True], [],
     "x^2 + y^2 = 6 t + C", "together"),
]  # fmt: skip


def rheonomic(quick: bool) -> Iterator[KnownScene]:
    """Relations and forms with time in them."""
    return map(tabled, TIMED[:: 4 if quick else 1])


def hidden_by_time(quick: bool) -> Iterator[KnownScene]:
    """Each coordinate the rate of the last: one finite relation at the start fixes all, and none leaves all free."""
    for n in (2, 3) if quick else (2, 3, 4, 6):
        names = [f"x{k}" for k in range(n)]
        rates = [f"x{k}dot = x{k + 1}" for k in range(n - 1)]
        last = n - 1
        # name, the row before, the row after, dof, do all integrate?, because, traits
        rows: list[tuple[str, list[str], list[str], int, bool, str, tuple[str, ...]]] = [
            ("nothing held", [], [], n, False, "Goursat's normal form in (t, x)", ("non-holonomic",)),
            ("the last held", [], [f"x{last} = 2"], 0, True, "polynomials in t", ("together",)),
            ("the first held", ["x0 = 0"], [], 0, True, "each rate is 0", ("time-hidden",)),
            ("the first a sine", ["x0 = sin(t)"], [], 0, True, "each is a derivative of it", ("time-hidden",)),
            ("both ends held as they are", ["x0 = 0"], [f"x{last} = 0"], 0, True, "each rate is 0", ("time-hidden",)),
            (
                "both ends held",
                ["x0 = 0"],
                [f"x{last} = 1e-12"],
                -1,
                True,
                "the last is 0",
                ("time-hidden", "tiny-gap"),
            ),
        ]
        for name, before, after, dof, integrate, because, traits in rows:
            constraints = [*before, *rates, *after]
            yield known_scene(
                f"{n} coordinates, {name}",
                scene_of(names, *constraints),
                because,
                traits,
                size=n,
                dof=dof,
                integrability=None if dof < 0 else {f"c{i + 1}": integrate for i in range(len(constraints))},
            )


FAMILIES = {"time": rheonomic, "rates of rates": hidden_by_time}
