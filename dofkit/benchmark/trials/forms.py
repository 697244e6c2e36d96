"""Differential constraints: forms that are integrable, not integrable, or only together; time; blocks; chains."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from dofkit.benchmark.trials.construction import KnownScene, Row, known_scene, numbered, scene_of, tabled, tables


def together() -> Iterator[KnownScene]:
    """Forms that are integrable or not together with the others of their system.

    Among them are five variables of growth 2, 3, 5 [Cartan1910].
    """
    return map(tabled, tables("forms.yaml")["together"])


# Time


def rheonomic() -> Iterator[KnownScene]:
    """Relations and forms with time in them."""
    return map(tabled, tables("forms.yaml")["time"])


def hidden_by_time() -> Iterator[KnownScene]:
    """Chains ``xk' = x(k+1)``: one geometric equation of x0 or of the last fixes all, and none leaves all free."""
    for n in (2, 3, 4, 6):
        names = [f"x{k}" for k in range(n)]
        rates = [f"x{k}dot = x{k + 1}" for k in range(n - 1)]
        last = f"x{n - 1}"
        # name, rows before, rows after, dof (-1: they contradict each other), because
        rows: list[tuple[str, list[str], list[str], int, str]] = [
            ("nothing held", [], [], n, "Goursat's normal form in (t, x)"),
            ("the last held", [], [f"{last} = 2"], 0, "polynomials in t"),
            ("the first held", ["x0 = 0"], [], 0, "each rate is 0"),
            ("the first a sine", ["x0 = sin(t)"], [], 0, "each is a derivative of it"),
            ("both ends held as they are", ["x0 = 0"], [f"{last} = 0"], 0, "each rate is 0"),
            ("both ends held", ["x0 = 0"], [f"{last} = 1e-12"], -1, "the last is 0"),
        ]
        for name, before, after, dof, because in rows:
            constraints = [*before, *rates, *after]
            labels = None if dof < 0 else dict.fromkeys(numbered(len(constraints)), dof == 0)
            about = f"{n} coordinates, {name}", scene_of(names, *constraints), because, n
            yield known_scene(*about, dof=dof, integrability=labels)


# Many small independent parts


def many_blocks() -> Iterator[KnownScene]:
    """Copies of one part, each in its own coordinates: the answers are those of one part."""
    blocks = tables("forms.yaml")["blocks"]
    for part in blocks:
        for n in (1, 4, 8, 16, 64):
            if n <= part["most"]:
                yield _blocks(f"{n} times {part['name']}", [part] * n, part["because"])
    for n in (1, 2, 4):
        yield _blocks(f"{n} of each", [*blocks] * n, "freedoms of separate parts add up")


def _blocks(name: str, blocks: Sequence[Row], because: str) -> KnownScene:
    """Return a scene of separate blocks, whose names end in the block's number; its dof is the sum of theirs."""
    names = [f"{q}{k}" for k, part in enumerate(blocks) for q in part["coordinates"].split()]
    rows = [
        {"name": f"part{k}_{i}", "type": "equation", "text": row.replace("{k}", str(k))}
        for k, part in enumerate(blocks)
        for i, row in enumerate(part["rows"])
    ]
    labels = {f"part{k}_{i}": value for k, part in enumerate(blocks) for i, value in enumerate(part["holonomic"])}
    over = [f"part{k}_{i}" for k, part in enumerate(blocks) for i in part["redundant"]]
    about = name, scene_of(names, *rows, parameters={"R": "positive"}), because, len(blocks)
    return known_scene(*about, dof=sum(part["dof"] for part in blocks), integrability=labels, redundancy=over)


# Long chains


def chained_forms() -> Iterator[KnownScene]:
    """Chains dq_i = q_{i+1} dq_0, i < n (Goursat's normal form): no form is integrable if open, all are if closed.

    Closed means a further form dq_n = q_0 dq_0 (or Riccati's equation), so that q_n, then q_{n-1}, ... depend on q_0.
    If a form in the middle is closed instead, the forms before it are integrable, and those after it are not.
    """
    for n in (2, 3, 4, 6, 8):
        names = [f"q{k}" for k in range(n + 1)]
        forms = [f"dq{k} - q{k + 1} dq0 = 0" for k in range(1, n)]
        half = n // 2
        closed_inside = [*forms[: half - 1], f"dq{half} - q0^2 dq0 = 0", *forms[half:]]
        closing = "with one form fewer than coordinates one direction is left, so all are integrable together"
        # name, the forms, dof, which are integrable (None: not asked), because
        members: list[tuple[str, list[str], int, dict[str, bool] | None, str]] = [
            (f"{n - 1} forms, open", forms, n + 1, dict.fromkeys(numbered(n - 1), False),
             "Goursat's normal form: each derived system loses one form, down to none"),
            (f"{n} forms, closed", [*forms, f"dq{n} - q0 dq0 = 0"], 1, dict.fromkeys(numbered(n), True), closing),
            (f"{n} forms, closed by a Riccati equation", [*forms, f"dq{n} - (q0 + q{n}^2) dq0 = 0"], 1,
             dict.fromkeys(numbered(n), True), closing),
            (f"{n - 1} forms, one of them closed", closed_inside, n + 1 - half,
             {f"c{k}": k <= half for k in range(1, n)} if n > 2 else None,
             "the forms before one in q0 alone are integrable with it; the forms after it are an open chain"),
        ]  # fmt: skip
        for name, rows, dof, labels, because in members:
            yield known_scene(name, scene_of(names, *rows), because, n, dof=dof, integrability=labels)


def trailers() -> Iterator[KnownScene]:
    """A car that steers with trailers: every configuration is reached [Laumond1993]; on a straight rail it is not."""
    controllable = "controllable: the derived system of n + 2 forms goes down to none (Laumond 1993)"
    straight = "its heading stays, so the axle runs straight and one direction is left: all integrate"
    for n in (0, 1, 2, 4, 8, 16, 24):
        scene = car(n)
        about = f"a car with {n} trailers", scene, controllable, n + 2
        labels = dict.fromkeys(numbered(n + 2), False)
        yield known_scene(*about, dof=n + 4, integrability=labels)
        if n <= 3:
            held = {**scene, "constraints": ["phi = 0", *scene["constraints"]]}
            about = f"a car with {n} trailers that does not steer", held, straight, n + 2
            labels = dict.fromkeys(numbered(n + 3), True)
            yield known_scene(*about, dof=1, integrability=labels)


def car(n: int) -> dict[str, Any]:
    """Return the scene of a car with n trailers hitched at the axles: n + 2 forms in n + 4 coordinates."""
    angles = [f"th{i}" for i in range(n + 1)]
    forms = ["sin(th0 + phi) dx - cos(th0 + phi) dy - l cos(phi) dth0 = 0"]
    for i, angle in enumerate(angles):
        arms = "".join(f" + l{j} cos({angle} - th{j}) dth{j}" for j in range(1, i + 1))
        forms.append(f"sin({angle}) dx - cos({angle}) dy{arms} = 0")
    lengths = {"l": "positive"} | {f"l{j}": "positive" for j in range(1, n + 1)}
    return scene_of(["x", "y", "phi", *angles], *forms, parameters=lengths)


FAMILIES = {
    "forms together": together,
    "time": rheonomic,
    "rates of rates": hidden_by_time,
    "many blocks": many_blocks,
    "chained forms": chained_forms,
    "trailers": trailers,
}
