"""Answers beside the constraint that they should be: the same, or a little less, more or other than that."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from dofkit.benchmark.trials.construction import KnownScene, known_scene, scene_of

#: What is done to ``u = 0`` (``{u}``, ``{q}`` a coordinate in it): is it the same, the trait, why.
Way = tuple[str, str, bool, str, str]
WAYS: tuple[Way, ...] = (
    ("negated", "-({u}) = 0", True, "rewritten", "a factor"),
    ("seven times", "7*({u}) = 0", True, "rewritten", "a factor"),
    ("tiny", "1e-12*({u}) = 0", True, "rewritten", "a factor"),
    ("times 1 + q^2", "(1 + {q}^2)*({u}) = 0", True, "rewritten", "a factor without zeros"),
    ("times e^q", "exp({q})*({u}) = 0", True, "rewritten", "a factor without zeros"),
    ("times 2 + sin q", "(2 + sin({q}))*({u}) = 0", True, "rewritten", "a factor without zeros"),
    ("over 1 + q^2", "({u})/(1 + {q}^2) = 0", True, "rewritten", "a factor without zeros"),
    ("in exp", "exp({u}) = 1", True, "rewritten", "exp is 1 at 0 only"),
    ("in sinh", "sinh({u}) = 0", True, "rewritten", "sinh is 0 at 0 only"),
    ("in atan", "atan({u}) = 0", True, "rewritten", "arc tangent is 0 at 0 only"),
    ("in a cubic", "({u})^3 + ({u}) = 0", True, "rewritten", "u (u^2 + 1) is 0 at 0 only"),
    ("squared", "({u})^2 = 0", False, "irregular", "no gradient on it"),
    ("cubed", "({u})^3 = 0", False, "irregular", "no gradient on it"),
    ("in cosh", "cosh({u}) = 1", False, "irregular", "no gradient on it"),
    ("times q - 7/3", "({q} - 7/3)*({u}) = 0", False, "weaker", "another branch"),
    ("off by 1e-9", "{u} = 1e-9", False, "tiny-difference", "another level"),
    ("off by 1e-15", "{u} = 1e-15", False, "tiny-difference", "another level"),
    ("off by 1e-9 q", "{u} + 1e-9*{q} = 0", False, "tiny-difference", "another set"),
    ("off by 1e-25 q", "{u} + 1e-25*{q} = 0", False, "tiny-difference", "another set"),
)


@dataclass(frozen=True)
class AskedConstraint:
    """A constraint u = 0 called ``asked`` among others, ``q`` a coordinate in it that is not 0 everywhere on it.

    ``answers``: further texts; are they the same, their trait, why.
    """

    name: str
    coordinates: str
    u: str
    q: str
    others: tuple[str, ...] = ()
    answers: tuple[tuple[str, bool, str, str], ...] = ()
    parameters: Mapping[str, str] | None = None

    def scene(self, text: str = "") -> dict[str, Any]:
        """The scene, with another text for the constraint where one is given."""
        rows = (*self.others, _asked_equation(text or f"{self.u} = 0"))
        return scene_of(self.coordinates.split(), *rows, parameters=dict(self.parameters or {}))


def _asked_equation(text: str) -> dict[str, str]:
    return {"name": "asked", "type": "equation", "text": text}


FINITE = (
    AskedConstraint("circle", "x y", "x^2 + y^2 - R^2", "x", (), (
        ("sqrt(x^2 + y^2) = R", True, "rewritten", "R is positive"),
        ("(x^2 + y^2)^2 = R^4", True, "rewritten", "x^2 + y^2 + R^2 has no zero"),
        ("log(x^2 + y^2) = 2 log(R)", True, "rewritten", "log is one to one"),
        ("(x - R)*(x + R) = -y^2", True, "rewritten", "multiplied out"),
        ("y = sqrt(R^2 - x^2)", False, "one-branch", "the upper half"),
        ("x^2 + y^2 = -R^2", False, "wrong-sign", "no point at all"),
        ("x^2 - y^2 = R^2", False, "wrong-sign", "a hyperbola"),
        ("x^2 + y^2 = R", False, "wrong-sign", "another radius"),
        ("x dx + y dy = 0", False, "differentiated", "every radius"),
        ("x + y = R", False, "wrong-sign", "a line"),
        ("x^2 + y^2 <= R^2", False, "weaker", "a disc"),
    ), {"R": "positive"}),
    AskedConstraint("line", "x y", "3 x + 4 y - 5", "x", (), (
        ("y = (5 - 3 x)/4", True, "rewritten", "solved for y"),
        ("x/4 + y/3 = 5/12", True, "rewritten", "divided by 12"),
        ("6 x + 8 y = 5", False, "wrong-sign", "a parallel line"),
        ("3 dx + 4 dy = 0", False, "differentiated", "every parallel line"),
        ("(3 x + 4 y)^2 = 25", False, "weaker", "a parallel line too"),
        ("3 x + 4.000000001 y = 5", False, "tiny-difference", "another slope"),
    )),
    AskedConstraint("turning line", "x y", "y cos(t) - x sin(t)", "x", (), (
        ("y cos(t) = x sin(t)", True, "rewritten", "the other side"),
        ("y cos(t) + x sin(t) = 0", False, "wrong-sign", "turns the other way"),
        ("y sin(t) = x cos(t)", False, "wrong-sign", "sine for cosine"),
        ("y cos(1) = x sin(1)", False, "wrong-sign", "does not turn"),
        ("y cos(t) = x sin(1.000000001 t)", False, "tiny-difference", "turns faster"),
        ("y cos(2 t) + x sin(2 t) - y = 0", False, "weaker", "2 sin(t) (x cos(t) - y sin(t)): another line"),
    )),
    AskedConstraint("exponential", "x y", "y - exp(x)", "x", (), (
        ("log(y) = x", True, "rewritten", "y is positive"),
        ("y exp(-x) = 1", True, "rewritten", "divided by exp(x)"),
        ("y^2 = exp(2 x)", False, "weaker", "y = -exp(x) too"),
        ("y^3 = exp(3 x)", True, "rewritten", "the cubic root is one to one, y is not 0"),
        ("dy = y dx", False, "differentiated", "every multiple"),
        ("y = 2.718281828^x", False, "tiny-difference", "not quite e"),
        ("y = exp(-x)", False, "wrong-sign", "falls"),
    )),
    AskedConstraint("sine", "x y", "y - sin(x)", "x", (), (
        ("y = 2 sin(x/2) cos(x/2)", True, "rewritten", "sine of twice a half"),
        ("y = cos(x - pi/2)", True, "rewritten", "shifted by a quarter"),
        ("asin(y) = x", False, "one-branch", "between -pi/2 and pi/2"),
        ("y = cos(x)", False, "wrong-sign", "cosine"),
        ("y^2 = 1 - cos(x)^2", False, "weaker", "y = -sin(x) too"),
        ("y = cos(x - 1.5707963267948966)", False, "tiny-difference", "not quite a quarter"),
        ("y = x - x^3/6 + x^5/120", False, "tiny-difference", "a Taylor polynomial"),
    )),
    AskedConstraint("hyperbola", "x y", "x y - 1", "x", (), (
        ("y = 1/x", True, "rewritten", "x is not 0 on it"),
        ("x^2 y^2 = 1", False, "weaker", "x y = -1 too"),
        ("x^3 y^3 = 1", True, "rewritten", "the cubic root is one to one, x y is not 0"),
        ("log(x) + log(y) = 0", False, "one-branch", "positive x and y"),
        ("(x + y)^2 - (x - y)^2 = 4", True, "rewritten", "4 x y"),
        ("x dy + y dx = 0", False, "differentiated", "every x y = C"),
    )),
    AskedConstraint("two lines", "x y", "x^2 - y^2", "x", (), (
        ("(x - y)*(x + y) = 0", True, "rewritten", "factored"),
        ("x = y", False, "one-branch", "one of them"),
        ("x = abs(y)", False, "one-branch", "the right half"),
        ("abs(x) = abs(y)", True, "rewritten", "the same squares"),
        ("x^4 = y^4", True, "rewritten", "x^2 + y^2 is 0 at their crossing only"),
    )),
    AskedConstraint("sphere and plane", "x y z", "x^2 + y^2 - 1", "x", ("z = 0",), (
        ("x^2 + y^2 + z^2 = 1", True, "combined", "z is 0"),
        ("x^2 + y^2 + 5 z = 1", True, "combined", "z is 0"),
        ("exp(z)*(x^2 + y^2) = 1 + z^3", True, "combined", "z is 0"),
        ("(x^2 + y^2 - 1)^2 + z^2 = 0", False, "irregular", "no gradient on it"),
        ("z = 0", False, "weaker", "the other one"),
        ("x^2 + y^2 + z^2 = 1 + 1e-12", False, "tiny-difference", "another radius"),
        ("x^2 + y^2 = 1 + sin(z)", True, "combined", "z is 0"),
        ("x^2 + y^2 = cos(z) + x z", True, "combined", "z is 0"),
        ("x^2 + y^2 = 1; z = 0", True, "combined", "both"),
    )),
    AskedConstraint("cosine beside sine", "x y u", "y - cos(u)", "u", ("x = sin(u)",), (
        ("x + y = sin(u) + cos(u)", True, "combined", "the sum"),
        ("y = cos(u) + (x - sin(u))^2", True, "combined", "x is sin(u)"),
        ("x^2 + y^2 = 1", False, "weaker", "y = -cos(u) too"),
        ("y = sqrt(1 - x^2)", False, "wrong-sign", "abs(cos(u))"),
        ("y = cos(u) + 1e-9*x", False, "tiny-difference", "another set"),
        ("dy + x du = 0", False, "differentiated", "cos(u) + C"),
    )),
    AskedConstraint("angle", "a b", "sin(a)", "a", ("b = cos(a)^2",), (
        ("tan(a) = 0", True, "rewritten", "the same zeros"),
        ("a = 0", False, "one-branch", "multiples of pi too"),
        ("sin(2 a) = 0", False, "weaker", "halves of pi too"),
        ("cos(2 a) = 1", False, "irregular", "1 - 2 sin^2"),
        ("b = 1", False, "irregular", "cos^2 = 1 has no slope there"),
    )),
    AskedConstraint("growing circle", "x y", "x^2 + y^2 - (1 + t)^2", "x", (), (
        ("x^2 + y^2 = 1 + 2 t + t^2", True, "rewritten", "multiplied out"),
        ("x^2 + y^2 = 1 + t^2", False, "wrong-sign", "a term is missing"),
        ("x^2 + y^2 = (1 + 1.000000000001 t)^2", False, "tiny-difference", "grows faster"),
        ("x dx + y dy = (1 + t) dt", False, "differentiated", "every radius at the start"),
    )),
)  # fmt: skip

MOVING = (
    AskedConstraint("contact form", "x y z", "dz - y dx", "x", (), (
        ("zdot = y xdot", True, "rewritten", "by dt"),
        ("(1 + x^2)*dz = (y + x^2 y) dx", True, "rewritten", "a factor without zeros"),
        ("exp(y) dz = y exp(y) dx", True, "rewritten", "a factor without zeros"),
        ("dz = -y dx", False, "wrong-sign", "the other sign"),
        ("dz = x dy", False, "wrong-sign", "another form"),
        ("dz = (y + 1e-9) dx", False, "tiny-difference", "another form"),
        ("dz = y dx + 1e-12 x dy", False, "tiny-difference", "another form"),
        ("z = x y", False, "weaker", "finite, and another"),
        ("(zdot - y xdot)^2 = 0", False, "irregular", "a square"),
        ("zdot^2 = y^2 xdot^2", False, "weaker", "the other sign too"),
        ("dz = y dx; dy = 0", False, "weaker", "says more"),
        ("dz = y dx + dt", False, "wrong-sign", "drifts"),
    )),
    AskedConstraint("disc", "x y th ph", "dx - R cos(th) dph", "th", ("dy = R sin(th) dph",), (
        ("xdot = R phdot cos(th)", True, "rewritten", "by dt"),
        ("dx + dy = R (cos(th) + sin(th)) dph", True, "combined", "the sum"),
        ("dx + 3 th dy = R (cos(th) + 3 th sin(th)) dph", True, "combined", "a combination"),
        ("dx = R sin(th) dph", False, "wrong-sign", "sine"),
        ("dx = -R cos(th) dph", False, "wrong-sign", "sign"),
        ("dx = cos(th) dph", False, "wrong-sign", "R is missing"),
        ("dy = R sin(th) dph", False, "weaker", "the other one"),
        ("dx = R (cos(th) + 1e-9) dph", False, "tiny-difference", "another form"),
        ("dx = R (1 - 2 sin(th/2)^2) dph", True, "rewritten", "cosine by its half"),
        ("x = R cos(th) ph", False, "weaker", "finite, and another"),
    ), {"R": "positive"}),
    AskedConstraint("exact form", "x y", "x dy + y dx", "x", (), (
        ("2 x dy = -2 y dx", True, "rewritten", "a factor"),
        ("x ydot + y xdot = 0", True, "rewritten", "by dt"),
        ("x y = 2", False, "differentiated", "one of its curves"),
        ("x dy = y dx", False, "wrong-sign", "sign"),
        ("x dy + (1 + 1e-12) y dx = 0", False, "tiny-difference", "another form"),
    )),
    AskedConstraint("driven", "x y", "dx - 3 dt", "x", (), (
        ("xdot = 3", True, "rewritten", "by dt"),
        ("2 xdot - 6 = 0", True, "rewritten", "a factor"),
        ("xdot = 3.000000000001", False, "tiny-difference", "faster"),
        ("x = 3 t", False, "differentiated", "from one place"),
        ("xdot^2 = 9", False, "weaker", "backwards too"),
        ("(xdot - 3)^2 = 0", False, "irregular", "a square"),
    )),
)  # fmt: skip
#: Of the ways, those that make sense of a form too.
FOR_FORMS = ("negated", "seven times", "tiny", "times 1 + q^2", "times e^q", "times 2 + sin q", "over 1 + q^2")


def answers(quick: bool) -> Iterator[KnownScene]:
    """Every constraint in every way of writing it, and in the ways of its own."""
    for number, asked in enumerate(FINITE):
        for turn, way in enumerate(WAYS):
            if (number + turn) % (16 if quick else 2) == 0 and (way[0] != "in a cubic" or number < 2):
                yield _rewritten(asked, way)
    for asked in () if quick else MOVING:
        yield from (_rewritten(asked, way) for way in WAYS if way[0] in FOR_FORMS)
    for asked in (*FINITE, *MOVING):
        for text, same, trait, because in asked.answers[:: 5 if quick else 1]:
            about = f"{asked.name}: {text}", asked.scene(), because, (trait,)
            yield known_scene(*about, equivalence=("asked", text, same))


def _rewritten(asked: AskedConstraint, way: Way) -> KnownScene:
    how, text, same, trait, because = way
    answer = ("asked", text.format(u=asked.u, q=asked.q), same)
    return known_scene(f"{asked.name}, {how}", asked.scene(), because, (trait,), equivalence=answer)


def inequalities(quick: bool) -> Iterator[KnownScene]:
    """A side of a surface: the same side of the same surface, or not."""
    disc = AskedConstraint("disc", "x y", "", "x", parameters={"R": "positive"})
    rows = [
        ("sqrt(x^2 + y^2) <= R", True, "rewritten"),
        ("R^2 >= x^2 + y^2", True, "rewritten"),
        ("-x^2 - y^2 >= -R^2", True, "rewritten"),
        ("3 x^2 + 3 y^2 <= 3 R^2", True, "rewritten"),
        ("x^2 + y^2 >= R^2", False, "wrong-sign"),
        ("x^2 + y^2 = R^2", False, "weaker"),
        ("x^2 + y^2 <= R", False, "wrong-sign"),
        ("x + y <= R", False, "wrong-sign"),
        ("x^2 + y^2 <= R^2 + 1e-9", False, "tiny-difference"),
    ]
    for text, truth, trait in rows[:: 4 if quick else 1]:
        made = disc.scene("x^2 + y^2 <= R^2")
        yield known_scene(text, made, "a disc", (trait, "inequality"), equivalence=("asked", text, truth))


def large_answers(quick: bool) -> Iterator[KnownScene]:
    """The same with many coordinates: spheres, sums of many rows, many forms."""
    for n in (3,) if quick else (3, 6, 12, 24):
        x = [f"x{k}" for k in range(n)]
        square = " + ".join(f"{q}^2" for q in x)
        sphere = scene_of(x, _asked_equation(f"{square} = 1"))
        rows = [f"x{k} = {k} x0" for k in range(1, n)]
        chain = scene_of([*x, "y"], *rows, _asked_equation("y = x0^2"))
        total = " + ".join(f"{k + 2}*(x{k} - {k} x0)" for k in range(1, n))
        forms = [f"dx{k} = y{k} dx0" for k in range(1, n)]
        names = [*x, *(f"y{k}" for k in range(1, n)), "z", "w"]
        moving = scene_of(names, *forms, _asked_equation("dz = w dx0"))
        summed = " + ".join(f"w*dx{k}" for k in range(1, n)), " + ".join(f"w*y{k}*dx0" for k in range(1, n))
        members = (
            (f"sphere in {n}, in exp", sphere, f"exp({square}) = E", True, "rewritten"),
            (f"sphere in {n}, squared", sphere, f"({square} - 1)^2 = 0", False, "irregular"),
            (f"sphere in {n}, another", sphere, f"{square} + 1e-9*x0*x1 = 1", False, "tiny-difference"),
            (f"{n} rows, their sum", chain, f"y + {total} = x0^2", True, "combined"),
            (f"{n} rows, not quite", chain, f"y + {total} = x0^2 + 1e-9*x0", False, "tiny-difference"),
            (f"{n} rows, but this", chain, f"{total} = 0", False, "weaker"),
            (f"{n} forms, their sum", moving, f"dz + {summed[0]} = w dx0 + {summed[1]}", True, "combined"),
            (f"{n} forms, not quite", moving, f"dz + {summed[0]} = w dx0 + {summed[1]} + 1e-9*dw", False,
             "tiny-difference"),
        )  # fmt: skip
        for name, made, text, truth, trait in members:
            about = name, made, "by its making", (trait, "large"), n
            yield known_scene(*about, equivalence=("asked", text, truth))


def tiny_answers(quick: bool) -> Iterator[KnownScene]:
    """A difference of 10^-k, in a finite relation and in a form, beside a factor of the same size."""
    for k in (6, 30) if quick else (3, 6, 9, 12, 15, 18, 24, 30, 60):
        e = f"1e-{k}"
        circle = scene_of(["x", "y"], _asked_equation("x^2 + y^2 = 4"))
        form = scene_of(["x", "y", "z"], _asked_equation("dz = y dx"))
        rows: tuple[tuple[str, dict[str, Any], str, bool], ...] = (
            ("radius", circle, f"x^2 + y^2 = 4 + {e}", False),
            ("ellipse", circle, f"x^2 + (1 + {e}) y^2 = 4", False),
            ("centre", circle, f"(x - {e})^2 + y^2 = 4", False),
            ("factor", circle, f"{e}*(x^2 + y^2 - 4) = 0", True),
            ("factor of each", circle, f"(1 + {e} x^2)*(x^2 + y^2) = 4 + 4*{e} x^2", True),
            ("form", form, f"dz = y dx + {e} dy", False),
            ("factor of a form", form, f"{e}*dz = {e}*y dx", True),
        )
        for name, made, text, truth in rows:
            trait = "rewritten" if truth else "tiny-difference"
            because = "a factor without zeros" if truth else "another set"
            about = f"{name}, {e}", made, because, (trait,)
            yield known_scene(*about, swept={"gap": float(e)}, equivalence=("asked", text, truth))


FAMILIES = {"answers": answers, "sides": inequalities, "large answers": large_answers, "tiny differences": tiny_answers}
