"""Applications: elementary functions, unknown functions, derivatives, roots and fractions."""

from __future__ import annotations

from collections.abc import Callable
from itertools import islice
from typing import NoReturn

from dofkit.expressions.calculus import by_time, diff, over_dt, total_differential
from dofkit.expressions.real_values import Comparison, applied, inverse, of_function, of_power
from dofkit.expressions.text.characters import MAX_DIFFERENTIATED, MAX_ORDER
from dofkit.expressions.text.grammar import Parser
from dofkit.expressions.text.names import AmbiguousError, Names
from dofkit.expressions.text.tokens import Token, tokenize
from dofkit.expressions.tree import DT, FUNCTIONS, MINUS_ONE, TIME, Expr, call, mul, nodes

_BARE = frozenset({"number", "value", "motion", "call", "function", "root", "frac", "|"})


def _applied(parser: Parser, token: Token, name: str, arguments: list[Expr]) -> Expr:
    """Return the elementary function ``name`` of ``arguments``. Raises TextError at ``token`` for a wrong number."""
    expected = FUNCTIONS.get(name, 1)
    if len(arguments) != expected:
        what = "one argument" if expected == 1 else f"{expected} arguments"
        parser.fail(f"`{name}` takes {what}, not {len(arguments)}", token, "check the commas")
    return parser.computed(token, applied, name, *arguments, needs=of_function(name, *arguments))


# Elementary functions


def function(parser: Parser, token: Token) -> Expr:
    """Read what follows a function's name, as in `sin(x)`, `sin x`, `sin^2(x)`, and return the value."""
    exponent = _function_power(parser, token.name)
    arguments = parser.enclosed(commas=True) if parser.next.kind == "(" else [_bare_argument(parser, token)]
    e = _applied(parser, token, token.name, arguments)
    return e if exponent is None else parser.raise_to(e, exponent, token)


def _function_power(parser: Parser, name: str) -> Expr | None:
    """Return the exponent of `sin^2(x)`, or None; a negative one is ambiguous and raises TextError."""
    token = parser.next
    if token.kind not in ("superscript", "^"):
        return None
    parser.at += 1
    exponent = token.expr
    if token.kind == "^":
        negative = parser.next.kind == "-"
        parser.at += negative
        exponent = parser.primary()
        exponent = mul(MINUS_ONE, exponent) if negative else exponent
    if exponent is None or exponent.op != "num" or exponent.args[0].denominator != 1:
        parser.fail(f"this power of `{name}` is not read", token, f"write `{name}(...)^(...)`")
    if exponent.args[0] < 0:
        inverse_name = f"`a{name}(...)`" if f"a{name}" in FUNCTIONS else "the inverse function"
        hint = f"write {inverse_name} or `1/{name}(...)`"
        parser.fail(f"`{name}^{exponent.args[0]}` may be the inverse function or a quotient", token, hint)
    return exponent


def _bare_argument(parser: Parser, token: Token) -> Expr:
    """Return a function's argument without parentheses: numbers, then one name or letters written together."""
    first = parser.next
    name = token.name
    if first.kind not in _BARE or FUNCTIONS.get(name, 1) != 1 or (first.kind == "|" and parser.bars):
        parser.fail(f"`{name}` needs its argument", first, f"write `{name}(...)`")
    factors = [parser.primary() if first.kind == "number" else parser.power()]
    if first.name == "degrees":
        return factors[0]
    if first.kind == "number":
        if parser.next.kind == "value" and name != "sqrt":
            factors.append(parser.power())
        elif parser.next.kind in ("^", "superscript", "motion", "function", "call", "(", "root", "frac"):
            _ask_extent(parser, token, first)
    if first.kind in ("number", "value"):
        while parser.next.kind == "value" and parser.next.start == parser.last.end:
            factors.append(parser.power())
    following = parser.next
    touching = following.start == parser.last.end
    rate = [t.kind for t in parser.tokens[parser.at : parser.at + 3]] == ["frac", "(", "motion"]
    doubtful = following.kind in ("value", "number", "root", "frac") or (following.kind == "(" and touching)
    if following.kind in ("*", "/") and touching:
        second = parser.tokens[parser.at + 1]
        doubtful = second.start == following.end and second.kind in ("value", "number", "(")
    if doubtful and not rate:
        _ask_extent(parser, token, first)
    return factors[0] if len(factors) == 1 else mul(*factors)


def _ask_extent(parser: Parser, token: Token, first: Token) -> NoReturn:
    """Raise AmbiguousError that asks how far the argument of `sin theta/2` reaches."""
    after, end = parser.next, parser.last.end
    beyond = parser.tokens[parser.at + 1] if after.kind in ("*", "/", "^") else after
    argument = parser.source(first.start, end)
    more = parser.source(end, beyond.end) + {"(": "...)", "frac": "..."}.get(beyond.kind, "")
    sign = "" if after.kind in ("*", "/", "^", "superscript") else "*"
    name = token.name
    readings = (f"{name}({argument}{sign}{more})", f"{name}({argument}){sign}{more}")
    follows = parser.text[beyond.end : beyond.end + 1]
    plain = parser.last.kind != ")" and beyond.kind in ("value", "number")
    complete = plain and (not follows or follows in " +-,=<>)]}")
    span = (parser.columns[token.start], parser.columns[beyond.end])
    message = f"it is not clear how far the argument of `{name}` reaches"
    hint = f"write `{readings[0]}` or `{readings[1]}`"
    raise AmbiguousError(message, parser.columns[after.start], hint, readings if complete else (), span)


def root(parser: Parser, token: Token) -> Expr:
    """Read what follows the sign, as in `√x`, `√(x + y)`, and return the square root."""
    first = parser.next
    if first.kind == "(":
        return _applied(parser, token, "sqrt", [parser.group()])
    if first.kind not in ("number", "value") or first.expr is None:
        parser.fail("`√` needs its argument", first, "write `sqrt(...)`")
    parser.at += 1
    after = parser.next
    if after.kind in ("^", "superscript", "prime") or (after.kind in ("value", "(") and after.start == first.end):
        short, long = parser.source(first.start, first.end), parser.source(first.start, after.end)
        hint = f"write `sqrt({long}...)` or `sqrt({short})...`"
        parser.fail("it is not clear how far `√` reaches", after, hint)
    if first.expr.op == "sym":
        parser.check_allowed(first.expr, token)
    return _applied(parser, token, "sqrt", [first.expr])


def fraction(parser: Parser, token: Token) -> Expr:
    """Read the two groups in braces of LaTeX's fraction and return the quotient; dx over dt is the velocity."""
    groups, brace = list[Expr](), token
    for _ in "ab":
        brace = parser.next
        if brace.kind != "(" or parser.text[brace.start] != "{":
            parser.fail("a fraction needs two groups in braces", brace, "write `(a)/(b)`")
        groups.append(parser.group())
    above, below = groups
    velocity = over_dt(above) if below == DT else None
    if velocity is not None:
        return velocity
    return mul(above, parser.computed(brace, inverse, below, needs=of_power(below, MINUS_ONE)))


# Unknown functions


def declared_function(parser: Parser, token: Token) -> Expr:
    """Read a declared function, as in `h(s)`, `h'(s)`, `h`, `hdot`, `dh`, and return its value or derivative."""
    name = token.name
    primes = parser.take() if parser.next.kind == "prime" and parser.next.start == token.end else None
    ahead = [t.kind for t in parser.tokens[parser.at : parser.at + 3]]
    if ahead == ["^", "number", "("] or ahead[:2] == ["superscript", "("]:
        hint = f"write `{name}(...)^2`, or `{name}^2*(...)`"
        parser.fail(f"a power stands between `{name}` and its argument", parser.next, hint)
    expected = parser.names.functions[name]
    if parser.next.kind == "(":
        arguments = parser.enclosed(commas=True)
        if len(arguments) != expected:
            what = "one argument" if expected == 1 else f"{expected} arguments"
            parser.fail(f"`{name}` is declared with {what}, not {len(arguments)}", token, "check the commas")
    else:
        arguments = _declared_arguments(parser, token)
    if primes is not None and expected != 1:
        message = f"`{name}` has {expected} arguments, so a prime does not say which of them to differentiate by"
        parser.fail(message, primes, f"write `diff({name}(...), x)` with the argument that is meant")
    e = call(name, arguments, (primes.amount,) if primes is not None else None)
    if token.amount == -1:
        return _allowed(parser, token, total_differential(e))
    for _ in range(token.amount):
        e = _allowed(parser, token, by_time(e))
    return e


def _declared_arguments(parser: Parser, token: Token) -> list[Expr]:
    """Return the arguments that the scene declares for a function whose name is written without arguments."""
    name = token.name
    declared = parser.names.arguments.get(name, ())
    if len(declared) != parser.names.functions[name]:
        parser.fail(f"the function `{name}` needs its argument", token, f"write `{name}(...)`")
    arguments = []
    for argument in declared:
        meaning = parser.names.lookup.meaning(argument)
        if meaning is None or meaning.kind != "value" or meaning.expr is None:
            message = f"`{name}` alone means `{name}({', '.join(declared)})`, and `{argument}` is not declared"
            parser.fail(message, token, f"write its argument, `{name}(...)`, or declare `{argument}`")
        if meaning.expr.op == "sym":
            parser.check_allowed(meaning.expr, token)
        arguments.append(meaning.expr)
    after = parser.next
    if after.kind == "value" and after.expr in arguments:
        written = parser.source(after.start, after.end)
        hint = f"write `{name}({written})` or `{name}({written})*{written}`"
        parser.fail(f"`{name} {written}` may be a value of `{name}` or a product", token, hint)
    return arguments


def _allowed(parser: Parser, token: Token, e: Expr | None) -> Expr:
    """Return the derivative ``e``. Raises TextError at ``token`` if it is None or has a symbol that is not allowed."""
    if e is None:
        hint = "write the derivative of an expression in coordinates, velocities and t"
        parser.fail("this expression cannot be differentiated with respect to time", token, hint)
    for symbol in sorted(e.symbols, key=lambda s: s.args):
        parser.check_allowed(symbol, token)
    return e


# Derivatives


def derivative_call(parser: Parser, token: Token) -> Expr:
    """Return the derivative that is written, e.g. `diff(h(a, b), a, 2, b)`, `partial(h(x, x), 1)`. Raises TextError."""
    name = token.name
    if parser.next.kind != "(":
        parser.fail(f"`{name}` needs its arguments", token, f"write `{name}(h(s), s)`")
    e, *steps = parser.enclosed(commas=True)
    if not steps:
        message = f"`{name}` needs an expression and the variable to differentiate by"
        parser.fail(message, token, f"write `{name}(h(s), s)`")
    if name == "partial" and any(step.op == "num" for step in steps):
        return _by_arguments(parser, token, e, steps)
    total = 0
    while steps:
        symbol = steps.pop(0)
        times = _order(parser, token, steps.pop(0)) if steps and steps[0].op == "num" else 1
        total += times
        if symbol.op != "sym" or total > MAX_ORDER:
            message = f"`{name}` differentiates by a coordinate, parameter or t, at most {MAX_ORDER} times"
            parser.fail(message, token, f"write `{name}(h(s), s)`")
        for _ in range(times):
            e = _differentiated(parser, token, e, symbol)
    return e


def _differentiated(parser: Parser, token: Token, e: Expr, symbol: Expr) -> Expr:
    """Return the derivative of ``e`` by ``symbol``: partial, but total for `diff` by time."""
    if sum(1 for _ in islice(nodes(e), MAX_DIFFERENTIATED)) >= MAX_DIFFERENTIATED:
        parser.fail("this expression is too long to be differentiated here", token, "write the derivative out")
    if symbol == TIME and token.name == "diff":
        return _allowed(parser, token, by_time(e))
    return diff(e, symbol)


def _order(parser: Parser, token: Token, e: Expr) -> int:
    """Return ``e`` as an order of differentiation. Raises TextError if it is not an integer from 1 to `MAX_ORDER`."""
    value = e.args[0]
    if value.denominator != 1 or not 1 <= value <= MAX_ORDER:
        parser.fail(f"{value} is not an order of differentiation", token, f"write a number from 1 to {MAX_ORDER}")
    return int(value)


def _by_arguments(parser: Parser, token: Token, e: Expr, steps: list[Expr]) -> Expr:
    """Return the partial derivative of an unknown function by arguments, given by number or as they are written."""
    if e.op != "call" or len(steps) > MAX_ORDER:
        parser.fail("only an unknown function has a first argument", token, "write `partial(h(x, y), 1)`")
    name, (*orders,), arguments = e.args
    for step in steps:
        places = [i for i, argument in enumerate(arguments) if argument == step]
        index = _order(parser, token, step) - 1 if step.op == "num" else places[0] if len(places) == 1 else len(orders)
        if index >= len(orders):
            parser.fail(f"`{name}` has no such argument", token, "write `partial(h(x, y), 1)`")
        orders[index] += 1
    return call(name, arguments, orders)


APPLICATIONS: dict[str, Callable[[Parser, Token], Expr]] = {
    "function": function,
    "call": declared_function,
    "operator": derivative_call,
    "root": root,
    "frac": fraction,
}


def parse_relations(text: str, names: Names) -> tuple[Comparison, ...]:
    """Return the relations in ``text``: one, or several for a chain such as ``0 <= x <= L``.

    A text without a relation means ``... = 0``. Raises TextError if the text cannot be read.
    """
    return Parser(tokenize(text, names.lookup), names, APPLICATIONS).relations()


def parse_expression(text: str, names: Names) -> Expr:
    """Return the expression in ``text``. Raises TextError if the text cannot be read or contains a relation."""
    return Parser(tokenize(text, names.lookup), names, APPLICATIONS).value()
