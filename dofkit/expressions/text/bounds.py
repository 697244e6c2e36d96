"""The bounds of a text, and arithmetic within them: what is beyond is refused before anything is computed with it."""

from __future__ import annotations

from fractions import Fraction

from dofkit.expressions.tree import MINUS_ONE, Expr, children, fn, mul, nodes, num, power

MAX_CHARACTERS = 2000
#: Numbers, names and signs in one text.
MAX_NODES = 1500
MAX_DEPTH = 60
MAX_NAME = 64
#: Digits of one number, and bits of all numbers of a text together.
MAX_DIGITS = 30
MAX_TEXT_BITS = 8192
#: Constant exponents, powers of ten included, and the product of nested ones.
MAX_EXPONENT = 64
#: Bits of one number after folding.
MAX_BITS = 2048
#: An expression with more nodes than this is not differentiated while it is being read.
MAX_DIFFERENTIATED = 150
#: How often `diff` differentiates.
MAX_ORDER = 6


class UndefinedError(Exception):
    """A value that does not exist or is too large; carries the sentence and the hint."""

    def __init__(self, message: str, hint: str) -> None:
        super().__init__(message)
        self.message = message
        self.hint = hint


def raised(base: Expr, exponent: Expr) -> Expr:
    """Return ``base^exponent``. Raises UndefinedError."""
    if exponent.op == "num":
        _check_power(base, exponent.args[0])
    elif base.op == "num" and base.args[0] <= 0:
        message = f"`{base.args[0]}` to a power that is no number has no real value for most exponents"
        raise UndefinedError(message, "write a positive base, or `exp(...)`")
    result = power(base, exponent)
    for part in result.args if result.op == "mul" else (result,):
        unfolded = part.op == "pow" and part.args[0].op == part.args[1].op == "num"
        if (unfolded and part.args[1].args[0].denominator == 1) or _bits(part) > MAX_BITS:
            raise UndefinedError("this power is too large a number", "write it in other units")
    return result


def _bits(e: Expr) -> int:
    """Return the bits of a number, and 0 for other expressions."""
    return max(e.args[0].numerator.bit_length(), e.args[0].denominator.bit_length()) if e.op == "num" else 0


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
    elif abs(value) > 1 and _degree(base, {}) * abs(value) > MAX_EXPONENT:
        message = f"these nested powers multiply to more than {MAX_EXPONENT}"
        raise UndefinedError(message, "choose smaller exponents")


def _degree(e: Expr, memo: dict[Expr, Fraction]) -> Fraction:
    """Return the largest product of nested constant exponents in ``e``."""
    if e not in memo:
        memo[e] = max((_degree(child, memo) for child in children(e)), default=Fraction(1))
        if e.op == "pow" and e.args[1].op == "num":
            memo[e] *= max(Fraction(1), abs(e.args[1].args[0]))
    return memo[e]


def inverse(divisor: Expr) -> Expr:
    """Return ``1/divisor``. Raises UndefinedError for zero."""
    if divisor.is_zero:
        raise UndefinedError("this divides by zero", "check the denominator")
    return power(divisor, MINUS_ONE)


def applied(name: str, *arguments: Expr) -> Expr:
    """Return the value of an elementary function. Raises UndefinedError where it does not exist."""
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
            raise UndefinedError(f"`{name}` has no real value at {where}", "check its argument")
    return fn(name, *arguments)


def product(factors: list[Expr]) -> Expr:
    """Return the product of ``factors``."""
    return factors[0] if len(factors) == 1 else mul(*factors)


def bounded(e: Expr) -> Expr:
    """Return ``e``. Raises UndefinedError where a number or a power in it has grown too large."""
    for node in nodes(e):
        if _bits(node) > MAX_BITS:
            raise UndefinedError("the numbers in this text multiply to one too large", "choose other units")
        if node.op == "pow" and node.args[1].op == "num" and abs(node.args[1].args[0].numerator) > MAX_EXPONENT:
            message = f"the powers in this text multiply to more than {MAX_EXPONENT}"
            raise UndefinedError(message, "choose smaller exponents")
    return e
