"""Random numbers, polynomials and functions as text; equations of a scene as text, and names within it."""

from __future__ import annotations

import random
import re
from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

WORD = re.compile(r"[A-Za-z_]\w*")


def texts(scene: Mapping[str, Any]) -> list[str]:
    """The equations of a scene in which nothing else stands."""
    return [c if isinstance(c, str) else c["text"] for c in scene["constraints"]]


def substituted(text: str, table: Mapping[str, str]) -> str:
    """With other words for those of the table."""
    return WORD.sub(lambda found: table.get(found[0], found[0]), text)


def words(text: str) -> set[str]:
    return set(WORD.findall(text))


def names(stem: str, many: int) -> list[str]:
    """``stem``1, ``stem``2, ..."""
    return [f"{stem}{k}" for k in range(1, many + 1)]


def nonzero(rng: random.Random, most: int = 5) -> int:
    return rng.choice((-1, 1)) * rng.randint(1, most)


def ratio(rng: random.Random) -> Fraction:
    """Not 0."""
    return Fraction(nonzero(rng, 7), rng.randint(1, 4))


def smaller(*dofs: int) -> Mapping[str, Sequence[int]]:
    """Freedoms, and as many velocities, of smaller components."""
    return {"dof": dofs, "velocity_dof": dofs}


def at(fields: Mapping[str, Any]) -> Mapping[str, str]:
    """A reference configuration as text."""
    return {name: str(value) for name, value in fields.items()}


def factor(value: Fraction | int | str) -> str:
    """A number that stands in a product."""
    return f"({value})"


def total(parts: Sequence[str]) -> str:
    return " + ".join(parts) if parts else "0"


def product(parts: Sequence[str]) -> str:
    return "*".join(parts) if parts else "1"


def monomial(rng: random.Random, symbols: Sequence[str], degree: int) -> str:
    """Of that degree, with a coefficient that is not 0."""
    powers = [rng.choice(symbols) for _ in range(degree)]
    counted = [(s, powers.count(s)) for s in sorted(set(powers))]
    return product([factor(nonzero(rng)), *(f"{s}^{k}" if k > 1 else s for s, k in counted)])


def polynomial(rng: random.Random, symbols: Sequence[str], degree: int = 2, terms: int = 2) -> str:
    """With rational coefficients, and no constant."""
    return total([monomial(rng, symbols, rng.randint(1, degree)) for _ in range(terms)])


def decimal(value: Fraction) -> str:
    """As a decimal, which it is exactly."""
    digits = next(k for k in range(200) if (value * 10**k).denominator == 1)
    number, sign = str(abs(int(value * 10**digits))).rjust(digits + 1, "0"), "-" if value < 0 else ""
    return f"{sign}{number[: len(number) - digits]}.{number[len(number) - digits :]}" if digits else sign + number


#: Smooth on the whole line; ``#`` is the argument.
SMOOTH = (
    "sin(#)",
    "cos(#)",
    "exp(#)",
    "atan(#)",
    "sqrt(1 + (#)^2)",
    "log(1 + (#)^2)",
    "1/(1 + (#)^2)",
    "(#)^3",
    "tanh(#)",
)
#: Smooth, and different where the arguments are.
INJECTIVE = ("exp(#)", "atan(#)", "(#)^3", "(#)^3 + (#)", "tanh(#)", "sinh(#)", "(#)^7")


def applied(pattern: str, argument: str) -> str:
    """A pattern with an argument for ``#``."""
    return pattern.replace("#", argument)


def smooth(rng: random.Random, symbols: Sequence[str]) -> str:
    """A function that is smooth everywhere."""
    return f"{applied(rng.choice(SMOOTH), rng.choice(symbols))} + {polynomial(rng, symbols)}"


def positive(rng: random.Random, symbols: Sequence[str]) -> str:
    """A function that is positive everywhere."""
    s, r = rng.choice(symbols), rng.choice(symbols)
    return rng.choice(
        (f"(1 + {s}^2)", f"exp({s})", f"(2 + sin({s}))", f"(3 + cos({s}*{r}))", f"({s}^2 + {r}^4 + 1)", "(7/3)")
    )


def simple_zero(rng: random.Random, name: str, a: Fraction | int, *, rational: bool = False) -> str:
    """A function of one coordinate with a simple zero at a, and no other zero near it."""
    shift = f"({name} - ({a}))"
    algebraic = (shift, f"{shift}*({name}^2 + 1)", f"({shift}^3 + {shift})", f"{shift}/(1 + {name}^2)")
    others = (f"sin({shift})", f"(exp({shift}) - 1)", f"atan({shift})", f"(sqrt(1 + {shift}) - 1)", f"sinh({shift})")
    return rng.choice(algebraic if rational else algebraic + others)
