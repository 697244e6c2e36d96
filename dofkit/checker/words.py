"""Words of a text: what each name means, and how letters written together fall into names."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

from dofkit.checker.errors import CheckError
from dofkit.checker.trees import FUNCTIONS, ONE, Tree, call, symbol

GREEK = {
    "α": "alpha", "β": "beta", "γ": "gamma", "δ": "delta", "ε": "epsilon", "ζ": "zeta", "η": "eta",
    "θ": "theta", "ι": "iota", "κ": "kappa", "λ": "lambda", "μ": "mu", "ν": "nu", "ξ": "xi", "π": "pi",
    "ρ": "rho", "σ": "sigma", "τ": "tau", "υ": "upsilon", "φ": "phi", "χ": "chi", "ψ": "psi", "ω": "omega",
    "Γ": "Gamma", "Δ": "Delta", "Θ": "Theta", "Λ": "Lambda", "Ξ": "Xi", "Π": "Pi", "Σ": "Sigma",
    "Φ": "Phi", "Ψ": "Psi", "Ω": "Omega",
}  # fmt: skip
#: Letters that are drawn in another way.
VARIANTS = dict(zip("ϑϕϵϱςϰµ∆", "θφερσκμΔ", strict=True))
#: One and two dots above a letter.
DOT, TWO_DOTS = "\u0307", "\u0308"
SYNONYMS = {"arcsin": "asin", "arccos": "acos", "arctan": "atan", "arctan2": "atan2", "ln": "log", "cosec": "csc"}
ELEMENTARY = {**{name: name for name in FUNCTIONS}, **SYNONYMS}
OPERATORS = ("diff", "partial")
PI = Tree("pi")
EULER = call("exp", ONE)
LONGEST_NAME = 64

_INDEXED = re.compile(r"(.*[A-Za-z])(_?)(\d+)")
_SUFFIXED = re.compile(r"(.+?)_?(d?dot)(_.*)?")
_MARKED = re.compile(f"([^{DOT}{TWO_DOTS}]+)([{DOT}{TWO_DOTS}]+)([_0-9][^{DOT}{TWO_DOTS}]*)?")


class Meaning(NamedTuple):
    """What a word stands for.

    ``kind``: ``value`` (of ``tree``), ``moving`` (a velocity, differential or acceleration: ``tree``), ``function``
    (elementary), ``declared`` (a declared function, ``order`` times differentiated by time; -1 its differential) or
    ``operator`` (``diff``).
    """

    kind: str
    tree: Tree = ONE
    name: str = ""
    order: int = 0


def spelled_out(name: str) -> str:
    """A name with its Greek letters in Latin ones."""
    return "".join(GREEK.get(VARIANTS.get(c, c), c) for c in name)


@dataclass(frozen=True)
class KnownNames:
    """What a text may mention.

    ``coordinates`` have differentials ``dq``, velocities ``qdot`` and accelerations ``qddot``: these are the names of
    their symbols. ``values``: parameters, each a symbol or what it was given. ``functions``: the names of the
    arguments of each declared function.
    """

    coordinates: frozenset[str] = frozenset()
    values: Mapping[str, Tree] = field(default_factory=dict)
    functions: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    @cached_property
    def declared(self) -> dict[str, Meaning]:
        """The declared names, spelled out; ``x1`` and ``x_1`` are one name unless both are declared."""
        found: dict[str, Meaning] = {}
        entries = [(name, Meaning("declared", name=name)) for name in self.functions]
        entries += [(name, Meaning("value", tree)) for name, tree in self.values.items()]
        entries += [(name, Meaning("value", symbol(name), name)) for name in sorted(self.coordinates)]
        for name, meaning in entries:
            if spelled_out(name) in found:
                raise CheckError(f"the name '{name}' is declared twice")
            found[spelled_out(name)] = meaning
        twins = {}
        for word, meaning in found.items():
            match = _INDEXED.fullmatch(word)
            twin = f"{match[1]}{'' if match[2] else '_'}{match[3]}" if match else word
            if twin not in found and _built_in(twin) is None:
                twins[twin] = meaning
        return {**twins, **found}

    @cached_property
    def remembered(self) -> dict[str, tuple[tuple[Meaning, int], ...]]:
        """Words that were read before."""
        return {}

    def meaning(self, word: str) -> Meaning | None:
        """What a whole word means."""
        word = spelled_out(word)
        found = self.declared.get(word) or _built_in(word)
        if found is None and (match := _MARKED.fullmatch(word)):
            return self._moving(match[1] + (match[3] or ""), match[2].count(DOT) + 2 * match[2].count(TWO_DOTS))
        if found is None and word[0] == "d":
            found = self._moving(word[1:], -1)
        if found is None and "dot" in word and (match := _SUFFIXED.fullmatch(word)):
            found = self._moving(match[1] + (match[3] or ""), 1 if match[2] == "dot" else 2)
        return Meaning("value", EULER) if found is None and word == "E" else found

    def _moving(self, word: str, order: int) -> Meaning | None:
        base = self.declared.get(word)
        if base is None or order > 2:
            return None
        if base.kind == "declared":
            return base._replace(order=order)
        return moved(base.name, order) if base.name else None

    def parts(self, word: str) -> tuple[tuple[Meaning, int], ...]:
        """The factors of a word, each with the place where it ends."""
        if len(word) > LONGEST_NAME:
            raise CheckError(f"a name of {len(word)} letters is too long")
        if word not in self.remembered:
            whole = self.meaning(word)
            if len(self.remembered) > 5000:
                self.remembered.clear()
            self.remembered[word] = ((whole, len(word)),) if whole else self._split(word)
        return self.remembered[word]

    def _split(self, word: str) -> tuple[tuple[Meaning, int], ...]:
        ways: list[list[tuple[tuple[Meaning, int], ...]]] = [[()], *([] for _ in word)]
        for start in range(len(word)):
            for end in range(start + 1, len(word) + 1) if ways[start] else ():
                found = self._piece(word, start, end)
                if found is not None:
                    ways[end] += [(*before, (found, end)) for before in ways[start]]
                    del ways[end][2:]
        if not ways[-1]:
            raise CheckError(f"`{word}` is not declared")
        if len(ways[-1]) > 1:
            raise CheckError(f"`{word}` can be read as a product in several ways")
        return ways[-1][0]

    def _piece(self, word: str, start: int, end: int) -> Meaning | None:
        """The meaning of a part of a word; an index and a dot belong to the letter before them."""
        if not word[start].isalpha() or (end < len(word) and not word[end].isalpha()):
            return None
        found = self.meaning(word[start:end])
        if found is None or found.kind == "operator":
            return None
        return None if start and word[start:end].isascii() and found.tree in (PI, EULER) else found


def moved(name: str, order: int) -> Meaning | None:
    """The differential (-1), velocity (1) or acceleration (2) of a coordinate."""
    if order not in (-1, 1, 2):
        return None
    return Meaning("moving", symbol({-1: f"d{name}", 1: f"{name}dot", 2: f"{name}ddot"}[order]))


def _built_in(word: str) -> Meaning | None:
    if word in ELEMENTARY:
        return Meaning("function", name=ELEMENTARY[word])
    if word in OPERATORS:
        return Meaning("operator", name=word)
    if word == "pi":
        return Meaning("value", PI)
    if word == "t":
        return Meaning("value", symbol("t"))
    return Meaning("moving", symbol("dt")) if word == "dt" else None
