"""Words of a text: what each name means, how letters written together fall into names, and tokens, bounded."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from typing import NamedTuple

from dofkit.checker.trees import FUNCTIONS, ONE, CheckError, Tree, call, number, refuse, symbol

MOST_CHARACTERS, LONGEST_NAME = 20_000, 64
#: Digits of a number and of all numbers of a text, powers of ten counted.
MOST_DIGITS, LARGEST_POWER, MOST_DIGITS_IN_ALL = 400, 1000, 12_000
#: How often a declared function is differentiated.
MOST_ORDERS = 6
PI, EULER = Tree("pi"), call("exp", ONE)
_LATIN = (
    "alpha beta gamma delta epsilon zeta eta theta theta iota kappa lambda mu nu xi pi rho sigma tau upsilon phi phi "
    "chi psi omega Gamma Delta Theta Lambda Xi Pi Sigma Phi Psi Omega"
)
GREEK = dict(zip("αβγδεζηθϑικλμνξπρστυφϕχψωΓΔΘΛΞΠΣΦΨΩ", _LATIN.split(), strict=True))
#: A dot above the letter before it.
DOT = "\u0307"
_PLAIN = str.maketrans({
    **dict(zip("ȧḃċḋėḟġḣṁṅȯṗṙṡṫẇẋẏż", (f"{c}{DOT}" for c in "abcdefghmnoprstwxyz"), strict=True)),
    "−": "-", "–": "-", "·": "*", "⋅": "*", "×": "*", "≤": "<=", "≥": ">=", "′": "'", "’": "'", "\u00a0": " ",
    "\u2009": " ",
})  # fmt: skip
_LETTERS = "A-Za-z" + "".join(GREEK)
_TOKEN = re.compile(
    rf"(?P<space>[ \t]+)|(?P<word>[{_LETTERS}][{_LETTERS}0-9_{DOT}']*)"
    r"|(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,6})?(?!_))|(?P<relation><=|>=|==?|[<>])(?![=<>])"
    r"|(?P<sign>\*\*(?!\*)|/(?!/)|[-+*^(),\[\]{}])|(?P<raised>[²³](?! *(?:[²³^]|\*\*)))",
    re.ASCII,
)
_VELOCITY, _DIFFERENTIAL = re.compile(rf"(.+?)(?:_?dot|['{DOT}])([_0-9].*)?"), re.compile("d(.+)")


class Lexeme(NamedTuple):
    """A piece of a text; it may touch the one before it.

    ``kind``: ``number``, ``value`` (a name), ``moving`` (a velocity or differential), ``function`` (elementary),
    ``declared`` (a function, ``tree`` what it is by itself), ``operator`` (``diff``), ``relation``, ``end`` or a sign.
    """

    kind: str
    tree: Tree = ONE
    name: str = ""
    touching: bool = False


BUILT_IN = {
    **{name: Lexeme("function", name=name) for name in FUNCTIONS},
    **{f"arc{name}": Lexeme("function", name=f"a{name}") for name in ("sin", "cos", "tan", "tan2")},
    **{name: Lexeme("function", name=head) for name, head in (("ln", "log"), ("cosec", "csc"))},
    **{name: Lexeme("operator", name=name) for name in ("diff", "partial")},
    "pi": Lexeme("value", PI),
    "t": Lexeme("value", symbol("t")),
    "dt": Lexeme("moving", symbol("dt")),
}
_E = Lexeme("value", EULER)


def spelled_out(name: str) -> str:
    """A name with its Greek letters in Latin ones."""
    return "".join(GREEK.get(c, c) for c in name)


@dataclass(frozen=True)
class KnownNames:
    """What a text may mention.

    ``coordinates`` have differentials ``dq`` and velocities ``qdot``: these are the names of their symbols. ``values``:
    parameters, each a symbol or what it was given. ``functions``: the names of the arguments of each declared function.
    """

    coordinates: frozenset[str] = frozenset()
    values: Mapping[str, Tree] = field(default_factory=dict)
    functions: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    @cached_property
    def words(self) -> dict[str, Lexeme]:
        """What words mean, Greek letters spelled out; those of motions come besides."""
        entries = [(name, Lexeme("value", symbol(name), name)) for name in self.coordinates]
        entries += [(name, Lexeme("value", tree)) for name, tree in self.values.items()]
        known = {spelled_out(name): meaning for name, meaning in entries}
        own, plain = {}, known | {"t": BUILT_IN["t"]}
        for name, arguments in self.functions.items():
            given = tuple(plain[word].tree for word in map(spelled_out, arguments) if word in plain)
            for order in range(MOST_ORDERS + 1 if len(arguments) == 1 else 1):
                tree = Tree("apply", given, name, (order,) * len(arguments))
                own[spelled_out(name) + "'" * order] = Lexeme("declared", tree, name)
        refuse(len(known) < len(entries) or not known.keys().isdisjoint(own), "a name is declared twice")
        return {**BUILT_IN, **own, **known}

    def moved(self, word: str) -> Lexeme | None:
        """The velocity or differential of a coordinate; an index stands after the dot or before it."""
        for form, pattern in (("{}dot", _VELOCITY), ("d{}", _DIFFERENTIAL)):
            match = pattern.fullmatch(word)
            base = self.words.get("".join(match.groups(""))) if match else None
            if base and base.kind == "value" and base.name:
                return Lexeme("value" if "'" in word else "moving", symbol(form.format(base.name)))
        return None

    def meaning(self, word: str) -> Lexeme | None:
        """What a whole word means."""
        word = spelled_out(word)
        return self.words.get(word) or self.moved(word) or (_E if word == "E" else None)

    def parts(self, word: str) -> list[Lexeme]:
        """The factors of a word; an index, a dot and a prime belong to the letter before them."""
        refuse(len(word) > LONGEST_NAME, f"a name of {len(word)} letters is too long")
        if whole := self.meaning(word):
            return [whole]
        starts = [i for i, letter in enumerate(word) if letter.isalpha()]
        ways: dict[int, list[list[Lexeme]]] = {0: [[]]}
        for end in [*starts[1:], len(word)]:
            pieces = [(start, self.meaning(word[start:end])) for start in starts if start < end]
            ways[end] = [[*before, piece] for start, piece in pieces if piece for before in ways[start]][:2]
        refuse(not ways[len(word)], f"`{word}` is not declared")
        refuse(len(ways[len(word)]) > 1, f"`{word}` is a product in several ways")
        return ways[len(word)][0]


def tokens_of(text: str, names: KnownNames) -> list[Lexeme]:
    """The tokens of a text, closed by one of kind ``end``."""
    refuse(not isinstance(text, str) or len(text) > MOST_CHARACTERS, "a text of bounded length is needed")
    text = text.strip().translate(_PLAIN)
    found: list[Lexeme] = []
    place, digits, touching = 0, 0, False
    while place < len(text):
        match = _TOKEN.match(text, place)
        if match is None or digits > MOST_DIGITS_IN_ALL:
            raise CheckError(f"`{text[place : place + 12]}` cannot be read")
        place, kind, word = match.end(), str(match.lastgroup), match[0]
        if kind == "number":
            power = re.search("[eE]", word)
            refuse(power and names.words.get(power[0], _E) != _E, f"`{word}` may be a power of ten or hold a name")
            digits += len(word) + (abs(int(word[power.end() :])) if power else 0)
            found.append(Lexeme(kind, number(decimal_value(word)), touching=touching))
        elif kind == "word":
            found += [one._replace(touching=touching or i > 0) for i, one in enumerate(names.parts(word))]
        elif kind == "raised":
            found += [Lexeme("^"), Lexeme("number", number(2 if word == "²" else 3))]
        elif kind != "space":
            found.append(Lexeme(kind if kind == "relation" else word.replace("**", "^"), ONE, word, touching))
        touching = kind != "space"
    return [*found, Lexeme("end")]


def decimal_value(text: str) -> Fraction:
    """The exact value of a decimal, in bounded time."""
    digits, _, power = text.lower().partition("e")
    whole, _, rest = digits.partition(".")
    long = len(whole) + len(rest) > MOST_DIGITS or abs(int(power or "0")) > LARGEST_POWER
    refuse(long, "a number has too many digits")
    return Fraction(int(whole + rest), 10 ** len(rest)) * Fraction(10) ** int(power or "0")
