"""Arithmetic with bounds: powers, quotients and functions that stay small and are defined."""

from __future__ import annotations

from fractions import Fraction

from dofkit.expressions.text.limits import MAX_BITS, MAX_EXPONENT
from dofkit.expressions.tree import MINUS_ONE, Expr, children, fn, mul, nodes, num, power


class UndefinedError(Exception):
    """A value that does not exist or is too large; carries the sentence and the hint."""

    def __init__(self, message: str, hint: str) -> None:
        super().__init__(message)
        self.message = message
        self.hint = hint


def raised(base: Expr, exponent: Expr) -> Expr:
    """``base^exponent``, or UndefinedError."""
    if exponent.op == "num":
        _check_power(base, exponent.args[0])
    result = power(base, exponent)
    for part in result.args if result.op == "mul" else (result,):
        whole = part.op == "pow" and part.args[0].op == part.args[1].op == "num" and _is_whole(part.args[1])
        if whole or (part.op == "num" and _bits(part.args[0]) > MAX_BITS):
            raise UndefinedError("this power is too large a number", "write it in other units")
    return result


def _is_whole(e: Expr) -> bool:
    value: Fraction = e.args[0]
    return value.denominator == 1


def _bits(value: Fraction) -> int:
    return max(value.numerator.bit_length(), value.denominator.bit_length())


def _check_power(base: Expr, value: Fraction) -> None:
    if abs(value.numerator) > MAX_EXPONENT or value.denominator > MAX_EXPONENT:
        message = f"this exponent is too large; at most {MAX_EXPONENT} is read"
        raise UndefinedError(message, "choose a smaller exponent")
    if base.op == "num":
        if base.is_zero and value == 0:
            raise UndefinedError("`0^0` has no value", "write the number")
        if base.is_zero and value < 0:
            raise UndefinedError("this divides by zero", "check the denominator")
        if base.args[0] < 0 and value.denominator != 1:
            raise UndefinedError("a negative number has no real root", "write a real number")
    elif abs(value) > 1 and degree(base, {}) * abs(value) > MAX_EXPONENT:
        message = f"these nested powers multiply to more than {MAX_EXPONENT}"
        raise UndefinedError(message, "choose smaller exponents")


def degree(e: Expr, memo: dict[Expr, Fraction]) -> Fraction:
    """The largest product of nested constant exponents in ``e``."""
    found = memo.get(e)
    if found is None:
        found = max((degree(child, memo) for child in children(e)), default=Fraction(1))
        if e.op == "pow" and e.args[1].op == "num":
            found *= max(Fraction(1), abs(e.args[1].args[0]))
        memo[e] = found
    return found


def inverse(divisor: Expr) -> Expr:
    """``1/divisor``, or UndefinedError for zero."""
    if divisor.is_zero:
        raise UndefinedError("this divides by zero", "check the denominator")
    return power(divisor, MINUS_ONE)


def applied(name: str, arguments: list[Expr]) -> Expr:
    """An elementary function, or UndefinedError where its value does not exist."""
    first = arguments[0]
    if name == "sqrt":
        return raised(first, num(Fraction(1, 2)))
    if first.op == "num":
        value: Fraction = first.args[0]
        bad = (
            (name == "log" and value <= 0)
            or (name in ("asin", "acos") and abs(value) > 1)
            or (name in ("cot", "csc") and value == 0)
            or (name == "atan2" and value == 0 and arguments[1].is_zero)
        )
        if bad:
            raise UndefinedError(
                f"`{name}` has no real value at {', '.join(map(_short_text, arguments))}", "check its argument"
            )
    return fn(name, *arguments)


def _short_text(e: Expr) -> str:
    return str(e.args[0]) if e.op == "num" else "..."


def product(factors: list[Expr]) -> Expr:
    """The product of ``factors``."""
    return factors[0] if len(factors) == 1 else mul(*factors)


def check_numbers(e: Expr) -> None:
    """UndefinedError where a number or a power in ``e`` has grown too large."""
    for node in nodes(e):
        if node.op == "num" and _bits(node.args[0]) > MAX_BITS:
            raise UndefinedError("the numbers in this text multiply to one too large", "choose other units")
        if node.op == "pow" and node.args[1].op == "num" and abs(node.args[1].args[0].numerator) > MAX_EXPONENT:
            raise UndefinedError(
                f"the powers in this text multiply to more than {MAX_EXPONENT}", "choose smaller exponents"
            )
