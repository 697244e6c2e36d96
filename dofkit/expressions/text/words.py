"""Words: letters written together are one declared name, or a product of declared names in one way only."""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

from dofkit.base.errors import TextError
from dofkit.base.wording import closest
from dofkit.expressions.text.bounds import MAX_NAME
from dofkit.expressions.text.characters import spelled
from dofkit.expressions.text.names import ELEMENTARY, SYNONYMS, Lookup, Meaning, UnknownNameError, unmarked
from dofkit.expressions.tree import PI, E

_CONSTANT = "give the constant a name: `parameters: {C: real}`, and `... = C`"
_RELATIONS = "give each relation its own text"
#: Words of programs and of prose; each gets its own advice unless it is declared.
_FOREIGN: dict[str, str] = {
    **dict.fromkeys(("const", "constant", "konst", "cst", "cte"), _CONSTANT),
    **dict.fromkeys(("and", "or", "if", "else"), _RELATIONS),
    "not": "write `=`, `<=`, `>=`, `<` or `>`", "in": "write a chain `0 <= x <= L`", "is": "write `=`",
    "lambda": "a text is mathematics, not code", "True": "write an equation", "False": "write an equation",
    "None": "write an equation, or leave the field out", "nan": "write a number", "NaN": "write a number",
    "inf": "leave that bound out", "oo": "leave that bound out",
}  # fmt: skip
#: Names of units: a number has none here.
_UNITS = frozenset({
    "km", "m", "dm", "cm", "mm", "um", "nm", "in", "inch", "ft", "kg", "g", "mg", "lb", "s", "ms", "min", "h", "Hz",
    "N", "kN", "Nm", "J", "kJ", "W", "rad", "rpm", "Pa", "K", "mol",
})  # fmt: skip
_NEAR = 200


class WordPart(NamedTuple):
    """A part of a word: its meaning (None for the digits after a function's name) and its place in the word."""

    meaning: Meaning | None
    start: int
    end: int


def read_word(word: str, lookup: Lookup, column: int, called: bool, number: str = "") -> tuple[WordPart, ...]:
    """The pieces of ``word``; ``called`` says that a parenthesis follows, ``number`` is what stands before it."""
    whole = lookup.meaning(word)
    if whole is not None:
        return (WordPart(whole, 0, len(word)),)
    if len(word) > MAX_NAME:
        message = f"this name has {len(word)} letters; at most {MAX_NAME} are read"
        raise TextError(message, column, "write the product with `*`, or shorten the name")
    if word not in _FOREIGN:
        ways = _splits(word, lookup)
        if len(ways) == 1:
            return ways[0]
        if ways:
            raise _several(word, ways, column)
    if number and word in _UNITS:
        raise UnknownNameError(
            f"`{word}` is not declared, and numbers are written without units", column, _no_unit(word, number)
        )
    raise _unknown(word, lookup, column, called)


def _no_unit(word: str, number: str) -> str:
    if word == "rad":
        return f"angles are in radians: write `{number}`"
    return f"write `{number}`, with every quantity in one consistent system of units"


def _splits(word: str, lookup: Lookup) -> list[tuple[WordPart, ...]]:
    """At most two ways to read ``word`` as a product of known words."""

    @cache
    def ways(start: int, after_function: bool) -> tuple[tuple[WordPart, ...], ...]:
        if start == len(word):
            return ((),)
        found: list[tuple[WordPart, ...]] = []
        for piece in _pieces(word, start, after_function, lookup):
            function = piece.meaning is not None and piece.meaning.kind == "function"
            found.extend((piece, *rest) for rest in ways(piece.end, function))
            if len(found) > 1:
                break
        return tuple(found[:2])

    return list(ways(0, False))


def _pieces(word: str, start: int, after_function: bool, lookup: Lookup) -> list[WordPart]:
    """The known words that may begin at ``start``."""
    if word[start].isdigit():
        end = start
        while end < len(word) and word[end].isdigit():
            end += 1
        logarithm = word[:start].endswith(("log", "ln"))  # `log10` and `log2` name other functions
        return [WordPart(None, start, end)] if after_function and not logarithm else []
    found = []
    for end in range(start + 1, min(len(word), start + lookup.longest + 4) + 1):
        if end < len(word) and not (word[end].isalpha() or word[end].isdigit()):
            continue  # `_` and the dots above a letter belong to what stands before them
        meaning = lookup.meaning(word[start:end])
        if meaning is None or meaning.kind == "operator":
            continue
        if end < len(word) and word[end].isdigit() and meaning.kind != "function":
            continue
        if _alone(word, start, end) and meaning.expr in (PI, E):
            continue
        found.append(WordPart(meaning, start, end))
    return found


def _alone(word: str, start: int, end: int) -> bool:
    """True for Latin letters that are a number only where they begin a word: `piR`, never `spin`."""
    return start > 0 and word[start:end].isascii()


def _several(word: str, ways: list[tuple[WordPart, ...]], column: int) -> TextError:
    shown = " or ".join("`" + "*".join(word[p.start : p.end] for p in way) + "`" for way in ways)
    return TextError(f"`{word}` can be read as {shown}", column, "write `*` between the names")


def _unknown(word: str, lookup: Lookup, column: int, called: bool) -> UnknownNameError:
    if word in _FOREIGN:
        what = "is not declared" if _FOREIGN[word] is _CONSTANT else "has no meaning in a text"
        return UnknownNameError(f"`{word}` {what}", column, _FOREIGN[word])
    near = _nearest(word, lookup, called)
    what = f"there is no function `{word}`" if called else f"`{word}` is not declared"
    if word == "e":
        return UnknownNameError(what, column, "write `E` for Euler's number, or `exp(x)` for its powers")
    if word == "d":
        hint = "write the differential of `x` as `dx`, its velocity as `xdot`"
        return UnknownNameError(what, column, hint)
    if near:
        return UnknownNameError(what, column, f"did you mean `{near}`?")
    if called:
        known_functions = ", ".join([*list(lookup.names.functions)[:8], *(f for f in ELEMENTARY if f not in SYNONYMS)])
        return UnknownNameError(what, column, f"the functions are {known_functions}")
    known = lookup.declared
    listed = ", ".join(known[:8]) + (", ..." if len(known) > 8 else "")
    return UnknownNameError(what, column, f"the declared names are {listed}" if known else "no names are declared")


def _nearest(word: str, lookup: Lookup, called: bool = False) -> str | None:
    """The known name that looks most like ``word``."""
    target = spelled(word)
    declared = lookup.declared
    same = lookup.unmarked.get(unmarked(word))
    if same is not None:
        return same
    coordinates = lookup.names.coordinates
    pool = [*lookup.names.functions, *ELEMENTARY] if called else [*declared, "pi"]
    if target.startswith("d"):
        pool += ["d" + name for name in coordinates]
    if target.endswith("dot"):
        pool += [name + "dot" for name in coordinates]
    if len(pool) > _NEAR:  # keep the comparison short in a scene of thousands of names
        pool = [name for name in pool if abs(len(name) - len(target)) < 2 and _alike(name, target)][:_NEAR]
    return closest(target, pool, 0.5) or closest(target, [*declared[:_NEAR], *ELEMENTARY], 0.7)


def _alike(name: str, target: str) -> bool:
    return name[:1] == target[:1] or name[1:] == target[1:]
