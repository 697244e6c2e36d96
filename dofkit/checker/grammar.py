"""The grammar of texts: relations and values as most people write them, read into trees.

Words first: what each name means. Then, from loosest to tightest: relation, sum, term, factor, primary. What could be
read in two ways is an error; so is a notation that few people use, for which another text stands in the scene.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from typing import NamedTuple

from dofkit.checker.trees import FUNCTIONS, ONE, ZERO, Tree, add, call, is_partial, number, power, refuse, symbol, times

#: The last: how many primes a declared function has.
MOST_CHARACTERS, LONGEST_NAME, DEEPEST, LARGEST_EXPONENT, MOST_PRIMES = 20_000, 64, 60, 64, 6
#: The last: a dot above the letter before it.
PI, EULER, _TIME, _STEP, DOT = Tree("pi"), call("exp", ONE), symbol("t"), symbol("dt"), "\u0307"
_LATIN = (
    "alpha beta gamma delta epsilon zeta eta theta theta iota kappa lambda mu nu xi pi rho sigma tau upsilon phi phi "
    "chi psi omega Gamma Delta Theta Lambda Xi Pi Sigma Phi Psi Omega"
)
GREEK = dict(zip("αβγδεζηθϑικλμνξπρστυφϕχψωΓΔΘΛΞΠΣΦΨΩ", _LATIN.split(), strict=True))
_SPELLED = str.maketrans(GREEK)
_DOTTED = zip("ȧḃċḋėḟġḣṁṅȯṗṙṡṫẇẋẏż", "abcdefghmnoprstwxyz", strict=True)
_PLAIN = str.maketrans("−–·⋅×′’", "--***''") | {ord(dotted): letter + DOT for dotted, letter in _DOTTED}
_LETTERS = "A-Za-z" + "".join(GREEK)
DECIMAL = r"(?:\d{1,400}\.?\d{0,400}|\.\d{1,400})(?:[eE][+-]?\d{1,3})?"
_TOKEN = re.compile(
    rf"([ \t\u00a0\u2009]*)(?:(?P<word>[{_LETTERS}][{_LETTERS}0-9_{DOT}']*)|(?P<number>{DECIMAL})"
    r"|(?P<relation>[<>]=?|==?|[≤≥])|(?P<sign>\*\*|[-+*/^(),])"
    r"|(?P<raised>[²³])(?! *(?:[²³^]|\*\*))|(?P<unknown>.))",
    re.ASCII | re.DOTALL,
)
_VELOCITY, _DIFFERENTIAL = re.compile(rf"(.+?)(?:_?dot|['{DOT}])([_0-9].*)?"), re.compile("d(.+)")
_BEGIN = ("value", "moving", "function", "declared", "(")
#: With these what a function without parentheses is of may go on.
_LONGER = ("value", "number", "declared", "^", "/")


class Lexeme(NamedTuple):
    """A piece of a text; it may touch the one before it.

    ``kind``: ``number``, ``value`` (a name), ``moving`` (a velocity or differential), ``function`` (elementary),
    ``declared`` (a function, ``tree`` is it without its arguments), ``relation``, ``end`` or a sign.
    """

    kind: str
    tree: Tree = ONE
    name: str = ""
    touching: bool = False


BUILT_IN = {name: Lexeme("function", name=name) for name in FUNCTIONS}
BUILT_IN |= {"pi": Lexeme("value", PI), "t": Lexeme("value", _TIME), "dt": Lexeme("moving", _STEP)}
_E = Lexeme("value", EULER)


class Sided(NamedTuple):
    """One relation: ``tree`` is 0, or by its ``sign`` > 0 or >= 0."""

    tree: Tree
    sign: str = "="


def spelled_out(name: str) -> str:
    """A name with its Greek letters in Latin ones."""
    return name.translate(_SPELLED)


@dataclass(frozen=True)
class KnownNames:
    """What a text may mention.

    ``coordinates`` have velocities ``qdot``, and differentials ``dq``, which are ``qdot dt``. ``values``: parameters,
    each a symbol or what it was given. ``functions``: the names of the arguments of each declared function.
    """

    coordinates: frozenset[str] = frozenset()
    values: Mapping[str, Tree] = field(default_factory=dict)
    functions: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    @cached_property
    def words(self) -> dict[str, Lexeme]:
        """What words mean, Greek letters spelled out; those of motions come besides."""
        entries = [("t", _TIME), *((name, symbol(name)) for name in self.coordinates), *self.values.items()]
        for name, arguments in self.functions.items():
            orders = range(MOST_PRIMES + 1 if len(arguments) == 1 else 1)
            entries += [(name + "'" * k, Tree("apply", (), name, (k,) * len(arguments))) for k in orders]
        kinds = {"apply": "declared"}
        lexemes = {spelled_out(name): Lexeme(kinds.get(tree.head, "value"), tree, name) for name, tree in entries}
        refuse(len(lexemes) < len(entries), "a name is declared twice")
        return {**BUILT_IN, **lexemes}

    def moved(self, word: str) -> Lexeme | None:
        """The velocity or differential of a coordinate; an index stands after the dot or before it."""
        for pattern, step in ((_VELOCITY, ONE), (_DIFFERENTIAL, _STEP)):
            match = pattern.fullmatch(word)
            base = self.words.get("".join(match.groups(""))) if match else None
            if base and base.name in self.coordinates:
                return Lexeme("value" if "'" in word else "moving", symbol(f"{base.name}dot") * step)
        return None

    def meaning(self, word: str) -> Lexeme:
        """What a word means; a lexeme of kind ``""`` if nothing."""
        refuse(len(word) > LONGEST_NAME, f"a name of {len(word)} letters is too long")
        plain = spelled_out(word)
        return self.words.get(plain) or self.moved(plain) or (_E if plain == "E" else Lexeme(""))


def tokens_of(text: object, names: KnownNames) -> list[Lexeme]:
    """The tokens of a text, closed by one of kind ``end``."""
    refuse(not isinstance(text, (str, int)) or len(str(text)) > MOST_CHARACTERS, "a text of bounded length is needed")
    tokens: list[Lexeme] = []
    for match in _TOKEN.finditer(str(text).strip().translate(_PLAIN)):
        kind = str(match.lastgroup)
        word, touching = match[kind], not match[1]
        if kind == "word":
            lexeme = names.meaning(word)._replace(touching=touching)
            refuse(not lexeme.kind, f"`{word}` is not declared")
            tokens.append(lexeme)
        elif kind == "number":
            refuse(any(names.words.get(c, _E) != _E for c in "eE" if c in word), f"`{word}` may be a power of ten")
            tokens.append(Lexeme(kind, number(Fraction(word)), word, touching))
        elif kind == "raised":
            tokens += [Lexeme("^"), Lexeme("number", number("²³".index(word) + 2))]
        else:
            refuse(kind == "unknown", f"`{word}` cannot be read")
            tokens.append(Lexeme(kind if kind == "relation" else word.replace("**", "^"), ONE, word, touching))
    return [*tokens, Lexeme("end")]


def parse(text: object, names: KnownNames) -> Tree:
    """The value that a text writes."""
    return parse_relations(text, names, signs=False)[0].tree


def parse_relations(text: object, names: KnownNames, signs: bool = True) -> list[Sided]:
    """The relations of a text, left less right side; a text without a sign is ``= 0``, a chain is several."""
    reader = _Reader(text, names)
    side, relations = reader.sum(), []
    while signs and (sign := reader.accepted("relation").name):
        right = reader.sum()
        tree = add(right, -side) if sign[0] in "<≤" else add(side, -right)
        relations.append(Sided(tree, "=" if sign[0] == "=" else ">" if sign in "<>" else ">="))
        side = right
    reader.needed("end")
    return relations or [Sided(side)]


class _Reader:
    """One text, read from left to right."""

    def __init__(self, text: object, names: KnownNames) -> None:
        self.names, self.tokens = names, tokens_of(text, names)
        self.at = self.depth = 0

    @property
    def next(self) -> Lexeme:
        return self.tokens[self.at]

    def accepted(self, *kinds: str) -> Lexeme:
        """The next token, taken where it is of one of some kinds; else one of kind ``""``."""
        token = self.next if self.next.kind in kinds else Lexeme("")
        self.at += token.kind != ""
        return token

    def needed(self, *kinds: str) -> Lexeme:
        """The next token, which is of one of some kinds."""
        refuse(self.next.kind not in kinds, f"`{self.next.name or self.next.kind}` cannot stand here")
        return self.accepted(*kinds)

    def sum(self) -> Tree:
        """Terms, each with its sign before it."""
        terms = [self.term()]
        while self.next.kind in ("+", "-"):
            terms.append(self.term())
        return add(*terms)

    def term(self) -> Tree:
        """Factors; a space after a quotient makes what follows a factor of all that was before."""
        factors, quotient = [self.factor()], False
        while self.next.kind in ("*", "/", *_BEGIN):
            unclear = quotient and self.next.kind in _BEGIN and self.next.touching
            refuse(unclear, "what a fraction line covers is unclear")
            sign, factor = self.accepted("*", "/").kind, self.factor()
            quotient = sign == "/" and factor != _STEP
            factors.append(_power(factor, number(-1)) if sign == "/" else factor)
        product = times(*factors)
        return Tree("product", tuple(factors)) if product == ZERO and any(map(is_partial, factors)) else product

    def factor(self) -> Tree:
        """Signs, a primary and its power: ``-x^2`` is -(x^2), ``x^y^z`` is x^(y^z)."""
        self.depth += 1
        refuse(self.depth > DEEPEST, "a text is nested too deep")
        minus = False
        while sign := self.accepted("+", "-").kind:
            minus ^= sign == "-"
        tree = self.primary()
        if self.accepted("^").kind:
            tree = _power(tree, self.factor())
            of_time = self.next.kind == "(" and self.next.touching and self.tokens[self.at + 1].tree == _TIME
            refuse(of_time, "it may be a power or a factor")
        self.depth -= 1
        return -tree if minus else tree

    def primary(self) -> Tree:
        """Read a number, a name, a group or a function with arguments; refuse ``a(b)`` if a is no function."""
        if self.next.kind == "(":
            group, *more = self.arguments()
            refuse(more, "a comma stands in a group")
            return group
        token = self.needed("number", *_BEGIN)
        if token.kind in ("function", "declared"):
            return self.function(token) if token.kind == "function" else self.declared(token)
        after = self.tokens[self.at : self.at + 3]
        called = " ".join(lexeme.kind for lexeme in after) in ("( value )", "( number )") and token.kind != "number"
        refuse(called and (self.next.touching or after[1].tree == _TIME), "it may be a factor or a function")
        return token.tree

    def arguments(self) -> list[Tree]:
        """Values in parentheses, with commas between them."""
        self.needed("(")
        values = [self.sum()]
        while self.accepted(",").kind:
            values.append(self.sum())
        self.needed(")")
        return values

    def function(self, token: Lexeme) -> Tree:
        """``sin(x)``, ``sin^2(x)``, ``sin x dy``; ``sin x y``, ``sin x/2``, ``sin^-1(x)`` could be read in two ways."""
        exponent = self.needed("number").tree if self.accepted("^").kind else ONE
        alone = self.next.kind == "value"
        values = [self.primary()] if alone else self.arguments()
        longer = self.next.kind in _LONGER or (self.next.kind == "(" and self.next.touching)
        refuse(alone and longer, f"where `{token.name}` ends is unclear")
        pair, heads = token.name in ("atan2", "diff"), [value.head for value in values]
        refuse(len(values) != (2 if pair else 1), f"`{token.name}` has {len(values)} arguments")
        refuse(token.name == "diff" and heads != ["apply", "symbol"], "`diff` has a function and a name")
        return _power(ONE if (token.name, values) == ("exp", [ZERO]) else call(token.name, *values), exponent)

    def declared(self, token: Lexeme) -> Tree:
        """``h(s)``, ``h'(s)``."""
        values, function = tuple(self.arguments()), token.tree
        wrong = len(values) != len(function.orders)
        refuse(wrong, f"`{token.name}` is declared with {len(function.orders)} arguments")
        return Tree("apply", values, function.value, function.orders)


def _power(base: Tree, exponent: Tree) -> Tree:
    """A power within the bounds; powers of numbers are carried out."""
    raised, value = base.value, exponent.value
    if base == EULER:
        return call("exp", exponent)
    if isinstance(value, Fraction):
        refuse(max(abs(value.numerator), value.denominator) > LARGEST_EXPONENT, "an exponent is too large")
        if isinstance(raised, Fraction):
            refuse(raised <= 0 and (value <= 0 if raised == 0 else value.denominator != 1), "there is no such power")
            if value.denominator == 1:
                return number(raised ** int(value))
    return Tree("power", (base, ZERO)) if exponent == ZERO and is_partial(base) else power(base, exponent)
