"""Applications: elementary functions, unknown functions, derivatives, roots and fractions."""

from __future__ import annotations

from collections.abc import Callable
from typing import NoReturn

from dofkit.expressions.calculus import diff
from dofkit.expressions.domains import of_function, of_power
from dofkit.expressions.text.arithmetic import UndefinedError, applied, inverse, product
from dofkit.expressions.text.derivatives import by_time, over_dt, raise_order, size, total_differential
from dofkit.expressions.text.limits import MAX_DIFFERENTIATED, MAX_ORDER
from dofkit.expressions.text.names import AmbiguousError
from dofkit.expressions.text.reader import TextReader
from dofkit.expressions.text.tokens import Token
from dofkit.expressions.tree import DT, FUNCTIONS, MINUS_ONE, TIME, Expr, call, mul

_BARE = frozenset({"number", "value", "motion", "call", "function", "root", "frac", "|"})


def arguments(parser: TextReader) -> list[Expr]:
    """Values in parentheses with commas between."""
    opening = parser.take()
    bars, parser.bars = parser.bars, 0
    found = [parser.sum()]
    while parser.next.kind == ",":
        parser.at += 1
        found.append(parser.sum())
    parser.bars = bars
    parser.close(opening)
    return found


def checked(parser: TextReader, token: Token, name: str, given: list[Expr]) -> Expr:
    """The elementary function ``name`` at ``given``."""
    wanted = FUNCTIONS.get(name, 1)
    if len(given) != wanted:
        what = "one argument" if wanted == 1 else f"{wanted} arguments"
        parser.fail(f"`{name}` takes {what}, not {len(given)}", token, "check the commas")
    parser.domain |= dict.fromkeys(of_function(name, *given))
    try:
        return applied(name, given)
    except UndefinedError as fault:
        parser.fail(fault.message, token, fault.hint)


# Elementary functions


def function(parser: TextReader, token: Token) -> Expr:
    """`sin(x)`, `sin x`, `sin^2(x)`."""
    name = token.name
    exponent = function_power(parser, name)
    if parser.next.kind == "(":
        found = checked(parser, token, name, arguments(parser))
    else:
        found = checked(parser, token, name, [bare(parser, token)])
    return found if exponent is None else parser.raise_to(found, exponent, token)


def function_power(parser: TextReader, name: str) -> Expr | None:
    """The `2` of `sin^2(x)`; a negative one is a question."""
    token = parser.next
    if token.kind == "superscript":
        parser.at += 1
        exponent = token.expr
    elif token.kind == "^":
        parser.at += 1
        if parser.next.kind == "(":
            exponent = parser.group()
        elif parser.next.kind == "number":
            exponent = parser.take().expr
        else:
            sign = parser.next.kind == "-"
            if sign:
                parser.at += 1
            exponent = parser.primary()
            exponent = mul(MINUS_ONE, exponent) if sign else exponent
    else:
        return None
    if exponent is None or exponent.op != "num" or exponent.args[0].denominator != 1:
        parser.fail(f"this power of `{name}` is not read", token, f"write `{name}(...)^(...)`")
    if exponent.args[0] < 0:
        inverse_name = f"`a{name}(...)`" if f"a{name}" in FUNCTIONS else "the inverse function"
        hint = f"write {inverse_name} or `1/{name}(...)`"
        parser.fail(f"`{name}^{exponent.args[0]}` may be the inverse function or a quotient", token, hint)
    return exponent


def bare(parser: TextReader, token: Token) -> Expr:
    """The argument of a function without parentheses: numbers, then one name or letters written together."""
    first = parser.next
    name = token.name
    if first.kind not in _BARE or FUNCTIONS.get(name, 1) != 1 or (first.kind == "|" and parser.bars):
        parser.fail(f"`{name}` needs its argument", first, f"write `{name}(...)`")
    if first.kind == "number":
        parts = [parser.primary()]
        if first.name == "degrees":
            return parts[0]
        if parser.next.kind == "value":
            parts.append(parser.power())
        elif parser.next.kind in ("^", "superscript", "motion", "function", "call", "(", "root", "frac"):
            ask_extent(parser, token, first)
    else:
        parts = [parser.power()]
    if first.kind in ("number", "value"):
        while parser.next.kind == "value" and parser.next.start == parser.last.end:
            parts.append(parser.power())
    after = parser.next
    if after.kind in ("value", "number", "root", "frac") or (after.kind == "(" and after.start == parser.last.end):
        ask_extent(parser, token, first)
    if after.kind in ("*", "/") and after.start == parser.last.end:
        beyond = parser.tokens[parser.at + 1]
        if beyond.start == after.end and beyond.kind in ("value", "number", "("):
            ask_extent(parser, token, first)
    return product(parts)


def ask_extent(parser: TextReader, token: Token, first: Token) -> NoReturn:
    """`sin theta/2`: how far does the argument reach?"""
    after, end = parser.next, parser.last.end
    beyond = parser.tokens[parser.at + 1] if after.kind in ("*", "/", "^") else after
    argument = parser.source(first.start, end)
    more = parser.source(end, beyond.end) + ("...)" if beyond.kind == "(" else "")
    sign = "" if after.kind in ("*", "/", "^", "superscript") else "*"
    name = token.name
    ways = (f"{name}({argument}{sign}{more})", f"{name}({argument}){sign}{more}")
    hint = f"write `{ways[0]}` or `{ways[1]}`"
    follows = parser.text[beyond.end : beyond.end + 1]
    plain = parser.tokens[parser.at - 1].kind != ")" and beyond.kind in ("value", "number")
    closed = plain and (not follows or follows in " +-,=<>)]}")
    span = (parser.columns[token.start], parser.columns[beyond.end])
    told = f"it is not clear how far the argument of `{name}` reaches"
    raise AmbiguousError(told, parser.columns[after.start], hint, ways if closed else (), span)


def root(parser: TextReader, token: Token) -> Expr:
    """`√x`, `√(x + y)`."""
    first = parser.next
    if first.kind == "(":
        return checked(parser, token, "sqrt", [parser.group()])
    if first.kind not in ("number", "value") or first.expr is None:
        parser.fail("`√` needs its argument", first, "write `sqrt(...)`")
    parser.at += 1
    after = parser.next
    if after.kind in ("^", "superscript", "prime") or (after.kind in ("value", "(") and after.start == first.end):
        short, long = parser.source(first.start, first.end), parser.source(first.start, after.end)
        hint = f"write `sqrt({long}...)` or `sqrt({short})...`"
        parser.fail("it is not clear how far `√` reaches", after, hint)
    parser.check_allowed(first.expr, token)
    return checked(parser, token, "sqrt", [first.expr])


def fraction(parser: TextReader, token: Token) -> Expr:
    """LaTeX's fraction of two groups in braces."""
    parts = []
    for _ in range(2):
        brace = parser.next
        if brace.kind != "(" or parser.text[brace.start] != "{":
            parser.fail("a fraction needs two groups in braces", brace, "write `(a)/(b)`")
        parts.append(parser.group())
    above, below = parts
    moved = over_dt(above) if below == DT else None
    if moved is not None:
        return moved
    parser.domain |= dict.fromkeys(of_power(below, MINUS_ONE))
    try:
        return mul(above, inverse(below))
    except UndefinedError as fault:
        parser.fail(fault.message, brace, fault.hint)


# Unknown functions


def unknown(parser: TextReader, token: Token) -> Expr:
    """`h(s)`, `h'(s)`, `h` alone, and its derivatives by time `hdot`, `dh`."""
    name = token.name
    primes = parser.take() if parser.next.kind == "prime" and parser.next.start == token.end else None
    ahead = parser.tokens[parser.at : parser.at + 3]
    power_then_group = [t.kind for t in ahead] == ["^", "number", "("] or [t.kind for t in ahead[:2]] == [
        "superscript",
        "(",
    ]
    if power_then_group:
        hint = f"write `{name}(...)^2`, or `{name}^2*(...)`"
        parser.fail(f"a power stands between `{name}` and its argument", ahead[0], hint)
    wanted = parser.names.functions[name]
    if parser.next.kind == "(":
        given = arguments(parser)
        if len(given) != wanted:
            what = "one argument" if wanted == 1 else f"{wanted} arguments"
            parser.fail(f"`{name}` is declared with {what}, not {len(given)}", token, "check the commas")
    else:
        given = own_arguments(parser, token)
    if primes is not None and wanted != 1:
        hint = f"write `diff({name}(...), x)` with the argument that is meant"
        parser.fail(
            f"`{name}` has {wanted} arguments, so a prime does not say which of them to differentiate by", primes, hint
        )
    found = call(name, given, (primes.amount,) if primes is not None else None)
    return time_derivative_of(parser, token, found, token.amount)


def own_arguments(parser: TextReader, token: Token) -> list[Expr]:
    """What `h` alone is a function of, by its declaration."""
    name = token.name
    declared = parser.names.arguments.get(name, ())
    if len(declared) != parser.names.functions[name]:
        parser.fail(f"the function `{name}` needs its argument", token, f"write `{name}(...)`")
    given = []
    for argument in declared:
        meaning = parser.names.lookup.meaning(argument)
        if meaning is None or meaning.kind != "value" or meaning.expr is None:
            message = f"`{name}` alone means `{name}({', '.join(declared)})`, and `{argument}` is not declared"
            parser.fail(message, token, f"write its argument, `{name}(...)`, or declare `{argument}`")
        if meaning.expr.op == "sym":
            parser.check_allowed(meaning.expr, token)
        given.append(meaning.expr)
    after = parser.next
    if after.kind == "value" and after.expr in given:
        shown = parser.source(after.start, after.end)
        hint = f"write `{name}({shown})` or `{name}({shown})*{shown}`"
        parser.fail(f"`{name} {shown}` may be a value of `{name}` or a product", token, hint)
    return given


def time_derivative_of(parser: TextReader, token: Token, found: Expr, order: int) -> Expr:
    """``found`` differentiated ``order`` times by time; its differential for -1."""
    if order == -1:
        return allowed_derivative(parser, token, total_differential(found))
    for _ in range(order):
        found = allowed_derivative(parser, token, by_time(found))
    return found


def allowed_derivative(parser: TextReader, token: Token, found: Expr | None) -> Expr:
    """A derivative that exists and holds only what is allowed."""
    if found is None:
        hint = "write the derivative of an expression in coordinates, velocities and t"
        parser.fail("this expression cannot be differentiated with respect to time", token, hint)
    for symbol in sorted(found.symbols, key=lambda s: s.args):
        parser.check_allowed(symbol, token)
    return found


# Derivatives


def derivative_call(parser: TextReader, token: Token) -> Expr:
    """`diff(x, t)`, `diff(h(s), s)`, `diff(h(a, b), a, 2, b)`, `partial(h(x, t), t)`, `partial(h(x, x), 1)`."""
    name = token.name
    if parser.next.kind != "(":
        parser.fail(f"`{name}` needs its arguments", token, f"write `{name}(h(s), s)`")
    given = arguments(parser)
    if len(given) < 2:
        parser.fail(
            f"`{name}` needs an expression and the variable to differentiate by", token, f"write `{name}(h(s), s)`"
        )
    found, steps = given[0], given[1:]
    if name == "partial" and any(step.op == "num" for step in steps):
        return by_place(parser, token, found, steps)
    position = total = 0
    while position < len(steps):
        symbol = steps[position]
        position += 1
        times = 1
        if position < len(steps) and steps[position].op == "num":
            times = whole(parser, token, steps[position])
            position += 1
        total += times
        if symbol.op != "sym" or total > MAX_ORDER:
            message = f"`{name}` differentiates by a coordinate, parameter or t, at most {MAX_ORDER} times"
            parser.fail(message, token, f"write `{name}(h(s), s)`")
        for _ in range(times):
            found = once(parser, token, found, symbol)
    return found


def once(parser: TextReader, token: Token, found: Expr, symbol: Expr) -> Expr:
    """One derivative; by time it is the total one for `diff`."""
    if size(found, MAX_DIFFERENTIATED) >= MAX_DIFFERENTIATED:
        parser.fail("this expression is too long to be differentiated here", token, "write the derivative out")
    if symbol == TIME and token.name == "diff":
        return allowed_derivative(parser, token, by_time(found))
    return diff(found, symbol)


def whole(parser: TextReader, token: Token, e: Expr) -> int:
    """A small counting number."""
    value = e.args[0]
    if value.denominator != 1 or not 1 <= value <= MAX_ORDER:
        parser.fail(f"{value} is not an order of differentiation", token, f"write a number from 1 to {MAX_ORDER}")
    return int(value)


def by_place(parser: TextReader, token: Token, found: Expr, steps: list[Expr]) -> Expr:
    """Derivatives of an unknown function by its first, second, ... argument."""
    if found.op != "call" or len(steps) > MAX_ORDER:
        parser.fail("only an unknown function has a first argument", token, "write `partial(h(x, y), 1)`")
    for step in steps:
        if step.op == "num":
            index = whole(parser, token, step) - 1
        else:
            places = [i for i, argument in enumerate(found.args[2]) if argument == step]
            index = places[0] if len(places) == 1 else len(found.args[2])
        if index >= len(found.args[2]):
            parser.fail(f"`{found.args[0]}` has no such argument", token, "write `partial(h(x, y), 1)`")
        found = raise_order(found, index)
    return found


READERS: dict[str, Callable[[TextReader, Token], Expr]] = {
    "function": function,
    "call": unknown,
    "operator": derivative_call,
    "root": root,
    "frac": fraction,
}
