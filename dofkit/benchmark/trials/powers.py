"""Equations that are not reduced, high powers, sums of squares, branches: what counts is the real set of zeros."""

from __future__ import annotations

from collections.abc import Iterator

from dofkit.benchmark.trials.construction import KnownScene, every, known_scene, numbered, scene_of

POWERS = (1, 2, 3, 8, 16, 32, 64)
#: The largest power of a sum that a scene may hold, as powers of powers are bounded.
LARGEST = 32


def high_powers(quick: bool) -> Iterator[KnownScene]:
    """Powers of an equation have its zeros, and no gradient there; x^k beside y^k are curves, points or nothing."""
    for k in (2, 3) if quick else POWERS:
        even = k % 2 == 0
        curve = "x^2 + y^2 - 1"
        # (name, coordinates, rows, dof, redundant: None where it is not asked, the trait)
        rows: list[tuple[str, list[str], list[str], int, list[str] | None, str]] = [
            ("a circle to the power", ["x", "y"], [f"({curve})^{k} = 0"], 1, [], "squared"),
            ("a plane and its power", ["x", "y", "z"], ["x + y = z", f"(x + y - z)^{k} = 0"], 2, ["c2"], "squared"),
            ("a power of x - y and x = 2 y", ["x", "y"], [f"(x - y)^{k} = 0", "x = 2 y"], 0, [], "squared"),
            ("x^k + y^k = 1", ["x", "y"], [f"x^{k} + y^{k} = 1"], 1, [], "high-power"),
            ("x^k + y^k = 0", ["x", "y"], [f"x^{k} + y^{k} = 0"], 0 if even else 1, [], "high-power"),
            ("x^k = -1", ["x", "y"], [f"x^{k} = -1"], -1 if even else 1, None if even else [], "high-power"),
            ("x^k = y^k", ["x", "y"], [f"x^{k} = y^{k}"], 1, [], "high-power"),
            ("x = y and x^k = y^k", ["x", "y"], ["x = y", f"x^{k} = y^{k}"], 1, ["c2"], "high-power"),
        ]
        for name, coordinates, texts, dof, over, trait in rows:
            if k > LARGEST and "(" in "".join(texts):
                continue
            yield known_scene(
                f"{name}, k = {k}",
                scene_of(coordinates, *texts),
                "a power is 0 where its base is; real even powers are not negative",
                (trait, "real") if "x^k +" in name or dof < 0 else (trait,),
                size=k,
                swept={"power": k},
                dof=dof,
                redundancy=over,
            )


def power_forms(quick: bool) -> Iterator[KnownScene]:
    """Forms with powers in them, and powers of forms."""
    for k in (2, 3) if quick else POWERS:
        # (name, text, integrates?, because)
        rows = [
            ("d(x^k y) + z", f"{k}*x^{k - 1}*y dx + x^{k} dy + dz = 0", True, "the differential of x^k y + z"),
            ("d(x^k y) and z dx", f"({k}*x^{k - 1}*y + z) dx + x^{k} dy = 0", False, "d of it is dz dx: x^k dy dz dx"),
            ("dz - y^k dx", f"dz - y^{k} dx = 0", False, "a contact form in y^k"),
            ("dz - x^k dx", f"dz - x^{k} dx = 0", True, "z - x^(k+1)/(k+1)"),
            ("a factor to the power", f"(1 + x^2 + y^2)^{k}*(dz + 2 y dy) = 0", True, "z + y^2"),
            ("a contact form, with it", f"(1 + x^2 + y^2)^{k}*(dz + y dx) = 0", False, "a contact form"),
            ("the power of an exact form", f"(zdot + 2 y ydot)^{k} = 0", True, "z + y^2"),
            ("the power of a contact form", f"(zdot + y xdot)^{k} = 0", False, "a contact form"),
        ]
        for name, text, integrates, because in rows:
            if k > LARGEST and text.startswith("("):
                continue
            yield known_scene(
                f"{name}, k = {k}",
                scene_of(["x", "y", "z"], text),
                because,
                ("squared", "nonlinear") if "the power of" in name else ("high-power",),
                size=k,
                swept={"power": k},
                dof=2 if integrates else 3,
                integrability={"c1": integrates},
            )


def sums_of_squares(quick: bool) -> Iterator[KnownScene]:
    """One equation that says n things: a sum of n squares; with a sign, or a constant, it does not."""
    for n in (2, 3) if quick else (2, 3, 4, 6, 8, 12):
        total, mixed = _sum(n, "(x{k} - {k})^2"), _sum(n, "(x{k} + 2 x{next})^2")
        rows: list[tuple[str, str, int, str, tuple[str, ...]]] = [
            ("a point", f"{total} = 0", 0, "every square is 0", ("sum-of-squares",)),
            ("a sphere", f"{total} = 1", n - 1, "a sphere", ("plain",)),
            ("nothing", f"{total} + 1 = 0", -1, "squares are not negative", ("contradiction", "real")),
            ("a cone", f"{total} = (x0 + 1)^2", n - 1, "a quadric with a regular point", ("plain",)),
            ("sums of two", f"{mixed} = 0", 0, "the matrix 1 + 2 shift is regular: x = 0", ("sum-of-squares",)),
            ("fourth powers", f"{_sum(n, 'x{k}^4')} = 0", 0, "all 0", ("sum-of-squares",)),
        ]
        names = [f"x{k}" for k in range(n)]
        for name, text, dof, because, traits in rows:
            yield known_scene(f"{name} of {n}", scene_of(names, text), because, traits, size=n, dof=dof)
        yield from _squared_forms(n, names)


def _squared_forms(n: int, names: list[str]) -> Iterator[KnownScene]:
    traits = ("sum-of-squares", "nonlinear")
    yield known_scene(
        f"{n} forms in one",
        scene_of([*names, "y"], f"(x0dot - x1 ydot)^2 + {_sum(n, '(x{k}dot - y ydot)^2', 1)} = 0"),
        "each square is 0: dx_k = y dy, and dx_0 = x_1 dy with it; one direction is left: they integrate",
        traits,
        size=n,
        dof=1,
        integrability={"c1": True},
    )
    yield known_scene(
        f"{n - 1} forms in one, and one that does not integrate",
        scene_of([*names, "y", "z"], f"{_sum(n, '(x{k}dot - z ydot)^2')} = 0"),
        "each square is 0: dx_k = z dy; differences integrate, the form does not",
        traits,
        size=n,
        dof=n + 2 - (n - 1),
        integrability={"c1": False},
    )


def _sum(n: int, text: str, first: int = 0) -> str:
    """A text for k = first, ..., n - 1, with a plus between; {next} is the index after k, and 0 after the last."""
    return " + ".join(text.format(k=k, next=(k + 1) % n) for k in range(first, n))


def branches(quick: bool) -> Iterator[KnownScene]:
    """Products: the set is the union of the branches, the freedom that of the largest."""
    # (name, coordinates, rows, dof, integrability: None for finite ones, because, trait)
    rows: list[tuple[str, list[str], list[str], int, dict[str, bool] | None, str, str]] = [
        ("two lines", ["x", "y"], ["x y = 0"], 1, {"c1": True}, "a line each", "plain"),
        ("two planes", ["x", "y", "z"], ["x^2 = y^2"], 2, {"c1": True}, "x = y or x = -y", "plain"),
        ("their crossing", ["x", "y", "z"], ["x^2 = y^2", "x + y = 0", "x - y = 1"], 1, every(numbered(3), True),
         "x = 1/2 and y = -1/2, where x^2 = y^2 holds: z is free", "plain"),
        ("a line and a circle", ["x", "y"], ["(x - 3)*(x^2 + y^2 - 1) = 0"], 1, {"c1": True}, "curves", "plain"),
        ("a line and a point", ["x", "y"], ["(x - 3)*(x^2 + y^2) = 0"], 1, {"c1": True}, "the line", "real"),
        ("a line, and no circle", ["x", "y"], ["(x - 3)*(x^2 + y^2 + 1) = 0"], 1, {"c1": True}, "the line", "real"),
        ("two empty ones", ["x", "y"], ["(x^2 + 1)*(y^2 + 1) = 0"], -1, None, "neither has a zero", "real"),
        ("two slopes", ["x", "y", "z"], ["xdot^2 = ydot^2"], 2, {"c1": True}, "x - y or x + y stays", "nonlinear"),
        ("two contact forms", ["x", "y", "z"], ["zdot^2 = y^2 xdot^2"], 3, {"c1": False},
         "dz = y dx or dz = -y dx: neither integrates", "nonlinear"),
        ("a speed", ["x", "y"], ["xdot^2 + ydot^2 = 1"], 2, {"c1": False}, "a cone of velocities", "nonlinear"),
        ("no speed", ["x", "y"], ["xdot^2 + ydot^2 = 0"], 0, {"c1": True}, "both velocities are 0", "nonlinear"),
        ("a negative speed", ["x", "y"], ["xdot^2 + ydot^2 = -1"], -1, None, "squares are not negative", "nonlinear"),
        ("an indefinite form", ["x", "y", "z"], ["xdot^2 + ydot^2 = zdot^2"], 3, {"c1": False},
         "a cone of velocities, which is no union of planes", "nonlinear"),
        ("one square", ["x", "y"], ["(x - y)^2*(x + y) = 0"], 1, {"c1": True}, "two lines", "squared"),
    ]  # fmt: skip
    for name, coordinates, texts, dof, labels, because, trait in rows[: 4 if quick else None]:
        yield known_scene(
            name, scene_of(coordinates, *texts), because, (trait,), size=len(coordinates), dof=dof, integrability=labels
        )


FAMILIES = {
    "high powers": high_powers,
    "powers in forms": power_forms,
    "sums of squares": sums_of_squares,
    "branches": branches,
}
