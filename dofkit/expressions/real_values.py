"""Conditions for powers, quotients and elementary functions to have a real value, and bounds on the numbers in them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

from dofkit.base.errors import TextError
from dofkit.expressions.calculus import substitute
from dofkit.expressions.tree import MINUS_ONE, ONE, Expr, children, fn, nodes, num, power

#: The largest constant exponent, powers of ten included, and the largest product of nested exponents.
MAX_EXPONENT = 64
#: Bits of one number after folding.
MAX_BITS = 2048


def raised(base: Expr, exponent: Expr) -> Expr:
    """Return ``base^exponent``. Raises TextError if the power has no real value or is too large."""
    if exponent.op == "num":
        _check_power(base, exponent.args[0])
    elif base.op == "num" and base.args[0] <= 0:
        message = f"`{base.args[0]}` to a power that is no number has no real value for most exponents"
        raise TextError(message, hint="write a positive base, or `exp(...)`")
    result = power(base, exponent)
    for part in result.args if result.op == "mul" else (result,):
        unfolded = part.op == "pow" and part.args[0].op == part.args[1].op == "num"
        if (unfolded and part.args[1].args[0].denominator == 1) or _bits(part) > MAX_BITS:
            raise TextError("this power is too large a number", hint="write it in other units")
    return result


def _bits(e: Expr) -> int:
    """Return the bits of a number, and 0 for other expressions."""
    return max(e.args[0].numerator.bit_length(), e.args[0].denominator.bit_length()) if e.op == "num" else 0


def _check_power(base: Expr, value: Fraction) -> None:
    """Raise TextError if ``base`` to the constant ``value`` has no real value or exceeds `MAX_EXPONENT`."""
    if abs(value.numerator) > MAX_EXPONENT or value.denominator > MAX_EXPONENT:
        message = f"this exponent is too large; at most {MAX_EXPONENT} is read"
        raise TextError(message, hint="choose a smaller exponent")
    if base.op == "num":
        if base.is_zero and value == 0:
            raise TextError("`0^0` has no value", hint="write the number")
        if base.is_zero and value < 0:
            raise TextError("this divides by zero", hint="check the denominator")
        if base.args[0] < 0 and value.denominator != 1:
            hint = "an even root is not real; write an odd one as `-(8^(1/3))`"
            raise TextError("a root of a negative number is not read", hint=hint)
    elif abs(value) > 1 and _degree(base, {}) * abs(value) > MAX_EXPONENT:
        message = f"these nested powers multiply to more than {MAX_EXPONENT}"
        raise TextError(message, hint="choose smaller exponents")


def _degree(e: Expr, memo: dict[Expr, Fraction]) -> Fraction:
    """Return the largest product of nested constant exponents in ``e``; ``memo`` keeps it by node."""
    if e not in memo:
        memo[e] = max((_degree(child, memo) for child in children(e)), default=Fraction(1))
        if e.op == "pow" and e.args[1].op == "num":
            memo[e] *= max(Fraction(1), abs(e.args[1].args[0]))
    return memo[e]


def inverse(divisor: Expr) -> Expr:
    """Return ``1/divisor``. Raises TextError if ``divisor`` is the number 0."""
    if divisor.is_zero:
        raise TextError("this divides by zero", hint="check the denominator")
    return power(divisor, MINUS_ONE)


def applied(name: str, *arguments: Expr) -> Expr:
    """Return the elementary function ``name`` of ``arguments``. Raises TextError if it has no real value there."""
    first = arguments[0]
    if name == "sqrt":
        return raised(first, num(Fraction(1, 2)))
    if first.op == "num":
        value: Fraction = first.args[0]
        undefined = (
            (name == "log" and value <= 0)
            or (name in ("asin", "acos") and abs(value) > 1)
            or (name in ("cot", "csc") and value == 0)
            or (name == "atan2" and value == 0 and arguments[1].is_zero)
        )
        if undefined:
            where = ", ".join(str(e.args[0]) if e.op == "num" else "..." for e in arguments)
            raise TextError(f"`{name}` has no real value at {where}", hint="check its argument")
    return fn(name, *arguments)


def bounded(e: Expr) -> Expr:
    """Return ``e`` unchanged. Raises TextError if a number or a power in ``e`` is too large."""
    for node in nodes(e):
        if _bits(node) > MAX_BITS:
            raise TextError("the numbers in this text multiply to one too large", hint="choose other units")
        if node.op == "pow" and node.args[1].op == "num" and abs(node.args[1].args[0].numerator) > MAX_EXPONENT:
            message = f"the powers in this text multiply to more than {MAX_EXPONENT}"
            raise TextError(message, hint="choose smaller exponents")
    return e


#: An expression, and how its value has to compare with 0.
DomainSense = Literal[">=", ">", "!="]
Requirement = tuple[Expr, DomainSense]


def of_power(base: Expr, exponent: Expr) -> Iterator[Requirement]:
    """Yield the requirements under which ``base^exponent`` is real; none for a number, which `raised` has checked."""
    if base.op == "num":
        return
    if exponent.op != "num":
        yield base, ">"
    elif exponent.args[0].denominator % 2 == 0:
        yield base, ">=" if exponent.args[0] > 0 else ">"
    elif exponent.args[0] < 0:
        yield base, "!="


def of_function(name: str, u: Expr, *others: Expr) -> Iterator[Requirement]:
    """Yield the requirements under which the elementary function ``name`` of ``u`` and ``others`` is real."""
    if name == "sqrt":
        yield u, ">="
    elif name == "log":
        yield u, ">"
    elif name in ("asin", "acos"):
        yield ONE - u * u, ">="
    elif name in ("tan", "sec"):
        yield fn("cos", u), "!="
    elif name in ("cot", "csc"):
        yield fn("sin", u), "!="
    elif name == "atan2":
        yield u * u + others[0] * others[0], "!="


RelationSign = Literal["=", "<=", ">=", "<", ">"]


@dataclass(frozen=True)
class Comparison:
    """One relation, with the ``column`` of its sign (of the beginning of the text, if there is no sign).

    ``domain``: the conditions under which the text has a real value as written, before any simplification.
    """

    left: Expr
    relation: RelationSign
    right: Expr
    column: int
    domain: tuple[Requirement, ...] = ()

    def substituted(self, table: Mapping[Expr, Expr]) -> Comparison:
        """Return the relation with expressions in place of symbols."""
        return Comparison(substitute(self.left, table), self.relation, substitute(self.right, table), self.column)
