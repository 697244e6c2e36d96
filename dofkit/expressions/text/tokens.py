"""Tokens: plain characters -> numbers, meanings of words, and signs, each with its place.

Letters written together are one declared name, or a product of declared names in one way only.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from fractions import Fraction
from functools import cache
from typing import NamedTuple, NoReturn

from dofkit.base.errors import TextError
from dofkit.expressions.real_values import MAX_EXPONENT
from dofkit.expressions.text.characters import (
    DEGREE,
    DOT,
    FRACTION_MARK,
    FRACTIONS,
    GREEK_LETTERS,
    MAX_CHARACTERS,
    MAX_DIGITS,
    MAX_NAME,
    MAX_NODES,
    MAX_TEXT_BITS,
    SUPERSCRIPTS,
    TWO_DOTS,
    Folded,
    fold,
    refusals,
    unlatex,
)
from dofkit.expressions.text.names import (
    FOREIGN,
    UNITS,
    VARIATION,
    Lookup,
    Meaning,
    UnknownNameError,
    spelled,
    unknown_name,
)
from dofkit.expressions.tree import PI, E, Expr, mul, num, sym


class Token(NamedTuple):
    """``kind``: number, superscript, prime, the kind of a `Meaning`, or the sign itself.

    ``start`` and ``end`` are places in the folded text; ``end`` of one token is ``start`` of the
    next where no space stands between.
    """

    kind: str
    start: int
    end: int
    expr: Expr | None = None
    name: str = ""
    amount: int = 0


class Tokens(NamedTuple):
    """The tokens, closed by one of kind ``end``, the folded text, and the column of each of its characters."""

    tokens: list[Token]
    text: str
    columns: Sequence[int]


WORD = rf"[A-Za-z{GREEK_LETTERS}][A-Za-z0-9_{GREEK_LETTERS}{DOT}{TWO_DOTS}]*"
NUMBER = r"(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?"
TOKEN = re.compile(
    rf"""[ \t]*(?:(?P<word>{WORD})
    |(?P<number>{NUMBER})
    |(?P<wrong>!=|=>|=<|<>|===|<<|>>|//|->|=!|:=|\*\*\*)
    |(?P<relation><=|>=|==?|[<>])
    |(?P<degree>\^[ ]*\{{[ ]*{DEGREE}[ ]*\}}|\^?[ ]*{DEGREE})
    |(?P<sign>\*\*|[-+*/^(),\[\]{{}}|√\\])
    |(?P<prime>'+)
    |(?P<superscript>[{"".join(SUPERSCRIPTS)}]+)
    |(?P<fraction>[{"".join(FRACTIONS)}])
    |(?P<end>$))""",
    re.ASCII | re.VERBOSE,
)
#: No character that stands for another, and no LaTeX.
_PLAIN = re.compile(r"[^\\{$\x00-\x1f\x7f-\U0010ffff]*")
_SQUARE = r"\s*(?:²|(?:\^|\*\*)\s*(?:2|\{\s*2\s*\}))"
_SECOND = re.compile(rf"d{_SQUARE}\s*(?P<name>{WORD})\s*/\s*dt{_SQUARE}", re.ASCII)
_SPACED_VARIATION = re.compile(rf"{VARIATION}[ \t]+(?P<name>{WORD})", re.ASCII)
_PARTS = re.compile(r"(\d*)\.?(\d*)(?:[eE]([+-]?\d+))?", re.ASCII)
_FACTOR = re.compile(r"\s*([^\W\d]\w*|[(\\])")
_DEGREES = frozenset({"deg", "degree", "degrees"})
_ALIKE = {"**": "^", "==": "=", "[": "(", "{": "(", "]": ")", "}": ")", FRACTION_MARK: "frac", "√": "root"}


def tokenize(text: str, lookup: Lookup) -> Tokens:
    """Return the tokens of ``text``; TextError at the first thing that is none."""
    if not isinstance(text, str):
        raise TextError(f"a text is needed, not {type(text).__name__}", 1, "put it in quotes")
    if (size := len(text)) > MAX_CHARACTERS:
        hint = "split it into several texts"
        raise TextError(f"the text has {size} characters; at most {MAX_CHARACTERS} are read", MAX_CHARACTERS + 1, hint)
    text = text.rstrip()
    plain, columns = Folded(text, range(1, len(text) + 2)) if _PLAIN.fullmatch(text) else unlatex(fold(text))
    return Tokens(_scan(plain, columns, lookup), plain, columns)


def without_latex(text: str) -> str | None:
    """Return a text in plain Latin letters and signs, or None where it holds what is not read."""
    try:
        return spelled(unlatex(fold(text)).text).strip()
    except TextError:
        return None


def _scan(text: str, columns: Sequence[int], lookup: Lookup) -> list[Token]:
    """Return the tokens of a text; ``columns``: the original column of each character. Raises TextError."""
    tokens: list[Token] = []
    position = len(text) - len(text.lstrip())
    match_at = TOKEN.match
    while True:
        match = match_at(text, position)
        if match is None:
            _stop(text, position, columns)
        kind = match.lastgroup or ""
        start, end = match.span(kind)
        motion = _motion(match[kind], text, start, lookup, columns) if kind == "word" else None
        if motion is not None:
            tokens.append(motion)
            end = motion.end
        elif kind == "degree" or (kind == "word" and match[kind] in _DEGREES and lookup.meaning(match[kind]) is None):
            tokens[-1:] = [_in_degrees(tokens, start, end, columns)]
        elif kind == "word":
            before = tokens[-1] if tokens and tokens[-1].kind == "number" else None
            if before and end == start + 1 and (factor := _FACTOR.match(text, end)) and factor[1] not in UNITS:
                before = None  # `1/2 m v^2`: a quantity and no unit
            number = "" if before is None else text[before.start : before.end]
            words = read_word(match[kind], lookup, columns[start], text[end : end + 1] == "(", number)
            tokens += [_word_token(part, start, text) for part in words]
        elif kind == "sign" or kind == "relation":
            sign = match[kind]
            sign = _ALIKE.get(sign, sign)
            tokens.append(Token("relation" if kind == "relation" else sign, start, end, None, sign))
        else:
            if kind == "prime" and (not tokens or tokens[-1].end != start):
                hint = "text needs no quotes; a prime stands right after a name: `x'`"
                raise TextError("a quote cannot stand here", columns[start], hint)
            tokens.append(_other(match, columns, text, lookup))
            if kind == "end":
                _check_size(tokens, columns)
                return tokens
        if len(tokens) > MAX_NODES:
            message = f"the text has more than {MAX_NODES} numbers, names and signs"
            raise TextError(message, columns[start], "split it into several texts")
        position = end


def _word_token(part: WordPart, start: int, text: str) -> Token:
    first, end, meaning = start + part.start, start + part.end, part.meaning
    if meaning is None:
        return Token("number", first, end, num(int(text[first:end])))
    return Token(meaning.kind, first, end, meaning.expr, meaning.name, meaning.order)


def _motion(word: str, text: str, start: int, lookup: Lookup, columns: Sequence[int]) -> Token | None:
    """Return the acceleration or the differential that begins at ``start``: ``d^2x/dt^2``, ``δ x``; None for none.

    ``δ x`` is a product where δ is declared.
    """
    if word[0] == "d" and (second := _SECOND.match(text, start)) is not None:
        name, column = second["name"], columns[second.start("name")]
        meaning = read_word(name, lookup, column, False)[0].meaning
        if meaning is not None and meaning.kind == "call":
            return Token("call", start, second.end(), None, meaning.name, 2)
        if meaning is not None and meaning.expr is not None and meaning.expr.args[:1] == ("coordinate",):
            return Token("motion", start, second.end(), sym("acceleration", meaning.expr.args[1]))
        message = f"`{name}` is not a coordinate, so it has no acceleration"
        raise TextError(message, column, f"declare it: `coordinates: [{name}]`")
    match = _SPACED_VARIATION.match(text, start) if word == VARIATION else None
    if match is None or lookup.meaning(VARIATION) is not None:
        return None
    differential = lookup.meaning(VARIATION + match["name"])
    if differential is None or differential.kind != "motion":
        return None
    return Token("motion", start, match.end(), differential.expr)


def _in_degrees(tokens: list[Token], start: int, end: int, columns: Sequence[int]) -> Token:
    """Return the number that stands before a sign of degrees, times pi/180."""
    before = tokens[-1] if tokens else None
    if before is None or before.kind != "number" or before.expr is None or before.expr.op != "num":
        hint = "write `60°`; write anything else than a number as `theta*pi/180`"
        raise TextError("a sign of degrees is read only after a number", columns[start], hint)
    return Token("number", before.start, end, mul(before.expr, num(Fraction(1, 180)), PI), "degrees")


def _check_size(tokens: list[Token], columns: Sequence[int]) -> None:
    """Refuse numbers that are small each and, multiplied, large."""
    total = 0
    for token in tokens:
        if token.kind == "number" and token.expr is not None:
            value: Fraction = (token.expr.args[0] if token.expr.op == "mul" else token.expr).args[0]
            total += value.numerator.bit_length() + value.denominator.bit_length() - 2
            if total > MAX_TEXT_BITS:
                hint = "split it into several texts, or choose other units"
                raise TextError("the numbers in this text have too many digits in total", columns[token.start], hint)


def _other(match: re.Match[str], columns: Sequence[int], text: str, lookup: Lookup) -> Token:
    """Return the token of a number, fraction, superscript, primes or the end. Raises TextError for other signs."""
    kind = match.lastgroup or ""
    written, (start, end) = match[kind], match.span(kind)
    column = columns[start]
    if kind == "number":
        _check_number(written, text, end, column, lookup)
        return Token(kind, start, end, num(_number(written, column)))
    if kind == "fraction":
        return Token("number", start, end, num(Fraction(*FRACTIONS[written])), "fraction")
    if kind == "superscript":
        digits = "".join(SUPERSCRIPTS[c] for c in written)
        if not digits.lstrip("+-").isdigit() or len(digits) > 4 or digits.rfind("-") > 0 or "+" in digits:
            message = f"the superscript `{written[:12]}` is not an exponent"
            raise TextError(message, column, "write `^` and the exponent")
        return Token(kind, start, end, num(int(digits)), written, int(digits))
    if kind == "wrong":
        message, hint = refusals("wrong").get(
            written, (f"`{written}` is not read", "write `=`, `<=`, `>=`, `<`, `>` or arithmetic")
        )
        raise TextError(message, column, hint)
    return Token(kind, start, end, None, written, len(written))


def _check_number(digits: str, text: str, end: int, column: int, lookup: Lookup) -> None:
    """Refuse what looks like a number and is read differently by different people."""
    after = text[end : end + 1]
    if after == "_":
        raise TextError("`_` inside a number is not read", column, "write the digits together, without `_`")
    if digits == "0" and after in tuple("xXoObB") and text[end + 1 : end + 2].isdigit():
        raise TextError("only decimal numbers are read", column, "write the number in decimal digits")
    if len(digits) > 1 and digits[0] == "0" and digits[1].isdigit():
        hint = f"write `{digits.lstrip('0') or '0'}`, and decimals with a point"
        raise TextError("a number does not begin with 0", column, hint)
    letter = "e" if "e" in digits else "E"
    if letter in digits and letter in lookup.declared:
        head, _, tail = digits.partition(letter)
        message = f"`{digits}` can be read as a power of ten or as a product with the declared name `{letter}`"
        raise TextError(message, column, f"write `{head}*10^({tail.lstrip('+')})` or `{head}*{letter}*{tail}`")


def _number(digits: str, column: int) -> Fraction:
    """Return the exact value of a decimal."""
    whole, decimals, power = _PARTS.findall(digits)[0]
    if (size := len(whole) + len(decimals)) > MAX_DIGITS:
        hint = "write fewer digits, or a fraction"
        raise TextError(f"this number has {size} digits; at most {MAX_DIGITS} are read", column, hint)
    value = Fraction(int(whole + decimals), 10 ** len(decimals))
    if not power:
        return value
    if len(power) > 6 or abs(int(power)) > MAX_EXPONENT:
        message = f"the power of ten in this number is too large; at most {MAX_EXPONENT} is read"
        raise TextError(message, column, "choose other units")
    return value * Fraction(10) ** int(power)


def _stop(text: str, position: int, columns: Sequence[int]) -> NoReturn:
    """Say what stands where no token begins."""
    position = len(text) - len(text[position:].lstrip(" \t\f\v"))
    char, column = text[position], columns[position]
    if text.startswith("..", position):
        raise TextError("an ellipsis is not read", column, "write out what the dots stand for")
    if char in refusals("strange"):
        message, hint = refusals("strange")[char]
        raise TextError(message, column, hint)
    quoted = f"`{char}`" if char.isprintable() else f"the control character U+{ord(char):04X}"
    raise TextError(f"{quoted} has no meaning here", column, "write arithmetic with names, numbers and `+ - * / ^`")


class WordPart(NamedTuple):
    """A part of a word: its meaning (None for the digits after a function's name) and its place in the word."""

    meaning: Meaning | None
    start: int
    end: int


def read_word(word: str, lookup: Lookup, column: int, called: bool, number: str = "") -> tuple[WordPart, ...]:
    """Return the parts of ``word``; ``called`` says that a parenthesis follows, ``number`` is what stands before it."""
    meaning = lookup.meaning(word)
    if meaning is not None:
        return (WordPart(meaning, 0, len(word)),)
    if len(word) > MAX_NAME:
        message = f"this name has {len(word)} letters; at most {MAX_NAME} are read"
        raise TextError(message, column, "write the product with `*`, or shorten the name")
    readings = [] if word in FOREIGN else _splits(word, lookup)
    if len(readings) == 1:
        return readings[0]
    if readings:
        written = " or ".join("`" + "*".join(word[p.start : p.end] for p in reading) + "`" for reading in readings)
        raise TextError(f"`{word}` can be read as {written}", column, "write `*` between the names")
    if number and word in UNITS:
        hint = f"write `{number}`, with every quantity in one consistent system of units"
        hint = f"angles are in radians: write `{number}`" if word == "rad" else hint
        raise UnknownNameError(f"`{word}` is not declared, and numbers are written without units", column, hint)
    raise unknown_name(word, lookup, column, called)


def _splits(word: str, lookup: Lookup) -> list[tuple[WordPart, ...]]:
    """Return at most two ways to read ``word`` as a product of known words."""

    @cache
    def readings(start: int, after_function: bool) -> tuple[tuple[WordPart, ...], ...]:
        """Return at most two ways to read the rest of the word: two mean that it is ambiguous."""
        if start == len(word):
            return ((),)
        complete: list[tuple[WordPart, ...]] = []
        for part in _beginnings(word, start, after_function, lookup):
            is_function = part.meaning is not None and part.meaning.kind == "function"
            complete.extend((part, *following) for following in readings(part.end, is_function))
            if len(complete) > 1:
                break
        return tuple(complete[:2])

    return list(readings(0, False))


def _beginnings(word: str, start: int, after_function: bool, lookup: Lookup) -> list[WordPart]:
    """Return the known words that may begin at ``start``."""
    if word[start].isdigit():
        digits = re.match(r"\d+", word[start:])
        logarithm = word[:start].endswith(("log", "ln"))  # `log10` and `log2` name other functions
        return [WordPart(None, start, start + digits.end())] if digits and after_function and not logarithm else []
    beginnings = []
    for end in range(start + 1, min(len(word), start + lookup.longest + 4) + 1):
        if end < len(word) and not (word[end].isalpha() or word[end].isdigit()):
            continue  # `_` and the dots above a letter belong to what stands before them
        meaning = lookup.meaning(word[start:end])
        if meaning is None or meaning.kind == "operator":
            continue
        if end < len(word) and word[end].isdigit() and meaning.kind != "function":
            continue
        if start and word[start:end].isascii() and meaning.expr in (PI, E):
            continue  # Latin letters are a number only where they begin a word: `piR`, never `spin`
        beginnings.append(WordPart(meaning, start, end))
    return beginnings
