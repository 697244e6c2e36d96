"""Expressions -> text in the grammar that this package reads."""

from __future__ import annotations

from fractions import Fraction
from itertools import chain, repeat

from dofkit.expressions.real_values import MAX_EXPONENT
from dofkit.expressions.text.characters import MAX_DIGITS
from dofkit.expressions.tree import HALF, TIME, Expr, num, power

_SUM, _PRODUCT, _POWER, _ATOM = range(4)
_LONGEST = 10**MAX_DIGITS
_SYMBOLS = {"velocity": "{}dot", "acceleration": "{}ddot", "differential": "d{}", "dt": "d{}"}
Printed = tuple[str, int]


def to_text(e: Expr) -> str:
    """Return ``e`` as a person would write it; reading it back gives ``e``, its factors perhaps in another order."""
    return _print(e)[0]


def _print(e: Expr) -> Printed:
    return _PRINTERS[e.op](e)


def _within(e: Expr, strength: int) -> str:
    """Return ``e`` in parentheses where it binds less tightly than ``strength``."""
    text, binding = _print(e)
    return text if binding >= strength else f"({text})"


def _digits(value: int) -> str:
    """Return a whole number from 0, in pieces that the tokenizer reads."""
    if value < _LONGEST:
        return str(value)
    zeros = 0
    while zeros < MAX_EXPONENT and value % 10 == 0:
        value, zeros = value // 10, zeros + 1
    if zeros:
        return f"({_digits(value)}*10^{zeros})"
    above, below = divmod(value, _LONGEST)
    return f"({_digits(above)}*10^{MAX_DIGITS} + {below})"


def _number(e: Expr) -> Printed:
    value: Fraction = e.args[0]
    sign = "-" if value < 0 else ""
    text = sign + _digits(abs(value.numerator))
    if value.denominator == 1:
        return text, _SUM if sign else _ATOM
    return f"{text}/{_digits(value.denominator)}", _SUM if sign else _PRODUCT


def _symbol(e: Expr) -> Printed:
    """Return the printed symbol; as `x_ddot` denotes an acceleration, the velocity of `x_d` is printed as `xdot_d`."""
    kind, name = e.args
    if kind == "velocity" and name.endswith("d"):  # `x_ddot` would be an acceleration
        stem, _, index = name.rpartition("_")
        return (f"{stem}dot_{index}" if stem else f"diff({name}, t)"), _ATOM
    return _SYMBOLS.get(kind, "{}").format(name), _ATOM


def _constant(e: Expr) -> Printed:
    return str(e.args[0]), _ATOM


def _sum(e: Expr) -> Printed:
    text = ""
    for term in e.args:
        part, _ = _print(term)
        if part.startswith("-"):
            text += f" - {part[1:]}" if text else part
        else:
            text += f" + {part}" if text else part
    return text, _SUM


def _product(e: Expr) -> Printed:
    """Return a product as printed: negative powers and denominators are written below a fraction bar."""
    above: list[Expr] = []
    below: list[Expr] = []
    sign = ""
    for part in e.args:
        if part.op == "num":
            value: Fraction = part.args[0]
            sign = "-" if value < 0 else ""
            if abs(value.numerator) != 1:
                above.append(num(abs(value.numerator)))
            if value.denominator != 1:
                below.append(num(value.denominator))
        elif part.op == "pow" and part.args[1].op == "num" and part.args[1].args[0] < 0:
            below.append(power(part.args[0], num(-part.args[1].args[0])))
        else:
            above.append(part)
    text = "*".join(_within(part, _POWER) for part in above) or "1"
    if below:
        divisor = "*".join(_within(part, _POWER) for part in below)
        text += f"/({divisor})" if len(below) > 1 else f"/{divisor}"
    return sign + text, _SUM if sign else _PRODUCT


def _power(e: Expr) -> Printed:
    base, exponent = e.args
    if exponent.op == "num" and exponent.args[0] < 0:
        return f"1/{_within(power(base, num(-exponent.args[0])), _POWER)}", _PRODUCT
    if exponent == HALF:
        return f"sqrt({to_text(base)})", _ATOM
    return f"{_within(base, _ATOM)}^{_within(exponent, _ATOM)}", _POWER


def _function(e: Expr) -> Printed:
    return f"{e.args[0]}({', '.join(map(to_text, e.args[1:]))})", _ATOM


def _call(e: Expr) -> Printed:
    """Return a call of a declared function, or its derivative as `f'(x)`, `diff(f(x), x)` or `partial(...)`."""
    name, orders, arguments = e.args
    plain = f"{name}({', '.join(map(to_text, arguments))})"
    if not any(orders):
        return plain, _ATOM
    if len(arguments) == 1 and arguments[0].op != "sym":
        return f"{name}{chr(39) * orders[0]}({to_text(arguments[0])})", _ATOM
    steps = [_step(arguments, index) for index in range(len(arguments))]
    named = all(step is not None for step, order in zip(steps, orders, strict=True) if order)
    if named and not _moves_with_time(arguments, orders):
        variables = (f"{step}, {n}" if n > 1 else step for step, n in zip(steps, orders, strict=True) if n)
        return f"diff({plain}, {', '.join(map(str, variables))})", _ATOM
    shown_steps = (step or str(i) for i, step in enumerate(steps, 1))
    places = chain.from_iterable(map(repeat, shown_steps, orders))
    return f"partial({plain}, {', '.join(places)})", _ATOM


def _step(arguments: tuple[Expr, ...], index: int) -> str | None:
    """Return the symbol that stands at ``index`` and nowhere else, by which `diff` differentiates."""
    symbol = arguments[index]
    elsewhere = any(symbol in other.symbols for i, other in enumerate(arguments) if i != index)
    return None if symbol.op != "sym" or elsewhere else to_text(symbol)


def _moves_with_time(arguments: tuple[Expr, ...], orders: tuple[int, ...]) -> bool:
    """Return whether the derivative by the argument t differs from the total derivative by time."""
    if not any(order and argument == TIME for argument, order in zip(arguments, orders, strict=True)):
        return False
    return any(s.args[0] not in ("parameter", "time") for argument in arguments for s in argument.symbols)


_PRINTERS = {
    "num": _number,
    "sym": _symbol,
    "const": _constant,
    "add": _sum,
    "mul": _product,
    "pow": _power,
    "fn": _function,
    "call": _call,
}
