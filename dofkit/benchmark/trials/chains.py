"""Long connected chains: links, bodies, forms, trailers, equations."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from dofkit.benchmark.trials.construction import KnownScene, every, known_scene, numbered, scene_of


def pendulums(quick: bool) -> Iterator[KnownScene]:
    """Links one after the other from the ground; closed on the ground; and with links written twice."""
    because = "each link takes one; a chain that is not straight is regular; a link written again adds nothing"
    for d, n in ((d, n) for n in ((2, 4) if quick else (2, 4, 8, 16, 32, 64, 128)) for d in (2, 3)):
        places = [[k, k * k % 3, k % 2][:d] for k in range(n + 1)]
        ends: list[Any] = [places[0], *(f"P{k}" for k in range(1, n + 1))]
        particles = [{"name": name, "at": at} for name, at in zip(ends[1:], places[1:], strict=True)]
        links = [_link(f"l{k}", ends[k], ends[k + 1]) for k in range(n)]
        twice = [_link(f"again{k}", ends[k], ends[k + 1]) for k in range(0, n, 2)]
        closed = [*links[:-1], _link(f"l{n - 1}", ends[n - 1], places[n])]
        for name, members, constraints, over in (
            ("open", particles, links, []),
            ("written twice", particles, [*links, *twice], [t["name"] for t in twice]),
            ("closed", particles[:-1], closed, []),
        ):
            dof = d * len(members) - n
            made = {"dimension": d, "particles": members, "constraints": constraints}
            about = f"{n} links in dimension {d}, {name}", made, because, ("redundant",) if over else ("long-chain",), n
            if dof >= 0:
                yield known_scene(*about, dof=dof, redundancy=over)


def _link(name: str, a: Any, b: Any) -> dict[str, Any]:
    return {"name": name, "type": "link", "between": [a, b]}


def bodies(quick: bool) -> Iterator[KnownScene]:
    """Bodies hinged one to the next, in the plane and in space; every third hinge welded too."""
    because = "an open chain: the freedoms of the joints add up; a hinge between welded bodies says nothing new"
    for d, n in ((d, n) for n in ((2, 4) if quick else (2, 4, 8, 16, 32)) for d in (2, 3)):
        names = ["ground", *(f"b{k}" for k in range(n))]
        hinges: list[dict[str, Any]] = []
        for k in range(n):
            hinge = {"name": f"h{k}", "type": "revolute", "between": names[k : k + 2], "at": [k, k % 2, 0][:d]}
            hinges.append(hinge | ({"axis": [k % 3, 1, k % 2]} if d == 3 else {}))
        welds = [{"name": f"w{k}", "type": "weld", "between": names[k : k + 2]} for k in range(0, n, 3)]
        for name, joints, dof, over in (
            ("hinged", hinges, n, []),
            ("every third welded first", [*welds, *hinges], n - len(welds), [f"h{k}" for k in range(0, n, 3)]),
        ):
            made = {"dimension": d, "bodies": names[1:], "constraints": joints}
            traits = ("redundant",) if over else ("long-chain", "joints")
            yield known_scene(
                f"{n} bodies in dimension {d}, {name}", made, because, traits, n, dof=dof, redundancy=over
            )


def chained_forms(quick: bool) -> Iterator[KnownScene]:
    """dq_i = q_i+1 dq_0: nothing integrates while the end is open, everything once it closes (Goursat's normal form).

    Closed: the last form reads dq_n = q_0 dq_0, so that q_n, then q_n-1, and so on are functions of q_0.
    """
    for n in (2, 3) if quick else (2, 3, 4, 6, 8):
        names = [f"q{k}" for k in range(n + 1)]
        forms = [f"dq{k} - q{k + 1} dq0 = 0" for k in range(1, n)]
        half = n // 2
        broken = [*forms[: half - 1], f"dq{half} - q0^2 dq0 = 0", *forms[half:]] if half else forms
        closing = "as many forms as coordinates but one leave one direction: all integrate together"
        # name, the forms, dof, which integrate (None: not asked), because, trait
        members: list[tuple[str, list[str], int, dict[str, bool] | None, str, str]] = [
            (f"{n - 1} forms, open", forms, n + 1, every(numbered(n - 1), False),
             "Goursat's normal form: each derived system loses one form, down to none", "non-holonomic"),
            (f"{n} forms, closed", [*forms, f"dq{n} - q0 dq0 = 0"], 1, every(numbered(n), True), closing, "together"),
            (f"{n} forms, closed by a Riccati equation", [*forms, f"dq{n} - (q0 + q{n}^2) dq0 = 0"], 1,
             every(numbered(n), True), closing, "together"),
            (f"{n - 1} forms, one of them closed", broken, n + 1 - half,
             {f"c{k}": k <= half for k in range(1, n)} if half < n - 1 or n > 2 else None,
             "what comes before a form in q0 alone integrates with it; what comes after is a chain of its own",
             "together"),
        ]  # fmt: skip
        for name, rows, dof, labels, because, trait in members:
            traits = (trait, "long-chain")
            yield known_scene(name, scene_of(names, *rows), because, traits, n, dof=dof, integrability=labels)


def trailers(quick: bool) -> Iterator[KnownScene]:
    """A car that steers with trailers: every configuration is reached [Laumond1993]; on a straight rail it is not."""
    controllable = "controllable: the derived system of n + 2 forms goes down to none (Laumond 1993)"
    straight = "its heading stays, so the axle runs straight and one direction is left: all integrate"
    for n in (0, 1) if quick else (0, 1, 2, 4, 8, 16, 24):
        made = car(n)
        about = f"a car with {n} trailers", made, controllable, ("non-holonomic", "long-chain"), n + 2
        labels = every(numbered(n + 2), False)
        yield known_scene(*about, swept={"member": "steers"}, dof=n + 4, integrability=labels)
        if n <= 3:
            held = {**made, "constraints": ["phi = 0", *made["constraints"]]}
            about = f"a car with {n} trailers that does not steer", held, straight, ("together", "long-chain"), n + 2
            labels = every(numbered(n + 3), True)
            yield known_scene(*about, swept={"member": "does not steer"}, dof=1, integrability=labels)


def car(n: int) -> dict[str, Any]:
    """Return n + 2 forms in n + 4 coordinates, the trailers hitched at the axles."""
    angles = [f"th{i}" for i in range(n + 1)]
    forms = ["sin(th0 + phi) dx - cos(th0 + phi) dy - l cos(phi) dth0 = 0"]
    for i, angle in enumerate(angles):
        arms = "".join(f" + l{j} cos({angle} - th{j}) dth{j}" for j in range(1, i + 1))
        forms.append(f"sin({angle}) dx - cos({angle}) dy{arms} = 0")
    lengths = {"l": "positive"} | {f"l{j}": "positive" for j in range(1, n + 1)}
    return scene_of(["x", "y", "phi", *angles], *forms, parameters=lengths)


def equations(quick: bool) -> Iterator[KnownScene]:
    """Relations each between neighbours: x_i+1 = f(x_i), and the ends tied once more, rightly or not."""
    for n in (3, 6) if quick else (3, 6, 12, 24):
        names = [f"x{k}" for k in range(n)]
        sums = [f"x{k + 1} = 2 x{k} + 1" for k in range(n - 1)]
        factor = 2 ** (n - 1)
        rows: Sequence[tuple[str, str, int, list[str], tuple[str, ...]]] = (
            ("tied rightly", f"x{n - 1} = {factor} x0 + {factor - 1}", 1, [f"c{n}"], ("redundant", "long-chain")),
            ("tied to another place", f"x{n - 1} = {factor} x0 + {factor}", -1, [], ("contradiction", "long-chain")),
            ("tied by another slope", f"x{n - 1} = {factor + 1} x0", 0, [], ("plain", "long-chain")),
        )
        for name, last, dof, over, traits in rows:
            because = f"x_n-1 = {factor} x_0 + {factor - 1} by the chain"
            about = f"{n} coordinates, {name}", scene_of(names, *sums, last), because, traits, n
            yield known_scene(*about, dof=dof, redundancy=over)


FAMILIES = {
    "chains of links": pendulums,
    "chains of bodies": bodies,
    "chained forms": chained_forms,
    "trailers": trailers,
    "chains of equations": equations,
}
