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
    "Φ": "Phi", "Ψ": "Psi", "Ω": "Omega", "ϑ": "theta", "ϕ": "phi",
}  # fmt: skip
#: A dot above the letter before it.
DOT = "\u0307"
SYNONYMS = {"arcsin": "asin", "arccos": "acos", "arctan": "atan", "arctan2": "atan2", "ln": "log", "cosec": "csc"}
ELEMENTARY = {**{name: name for name in FUNCTIONS}, **SYNONYMS}
PI = Tree("pi")
EULER = call("exp", ONE)
LONGEST_NAME = 64
_SUFFIXED = re.compile(r"(.+?)_?dot(_.*)?")
_DOTTED = re.compile(f"([^{DOT}]+){DOT}([_0-9][^{DOT}]*)?")


class WordMeaning(NamedTuple):
    """What a word stands for.

    ``kind``: ``value`` (of ``tree``), ``moving`` (a velocity or differential: ``tree``), ``function`` (elementary),
    ``declared`` (a declared function) or ``operator`` (``diff``).
    """

    kind: str
    tree: Tree = ONE
    name: str = ""


BUILT_IN = {
    **{name: WordMeaning("function", name=head) for name, head in ELEMENTARY.items()},
    **{name: WordMeaning("operator", name=name) for name in ("diff", "partial")},
    "pi": WordMeaning("value", PI),
    "t": WordMeaning("value", symbol("t")),
    "dt": WordMeaning("moving", symbol("dt")),
}


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
    def declared(self) -> dict[str, WordMeaning]:
        """The declared names, spelled out."""
        entries = [(name, WordMeaning("declared", name=name)) for name in self.functions]
        entries += [(name, WordMeaning("value", tree)) for name, tree in self.values.items()]
        entries += [(name, WordMeaning("value", symbol(name), name)) for name in self.coordinates]
        found = {spelled_out(name): meaning for name, meaning in entries}
        if len(found) < len(entries):
            raise CheckError("a name is declared twice")
        return found

    @cached_property
    def remembered(self) -> dict[str, tuple[WordMeaning, ...]]:
        """Words that were read before."""
        return {}

    def meaning(self, word: str) -> WordMeaning | None:
        """What a whole word means."""
        word = spelled_out(word)
        found = self.declared.get(word) or BUILT_IN.get(word)
        if found is None and (match := _DOTTED.fullmatch(word) or _SUFFIXED.fullmatch(word)):
            found = self.moved(match[1] + (match[2] or ""), "{}dot")
        if found is None and word[0] == "d":
            found = self.moved(word[1:], "d{}")
        return WordMeaning("value", EULER) if found is None and word == "E" else found

    def moved(self, word: str, form: str) -> WordMeaning | None:
        """The velocity ``{}dot`` or differential ``d{}`` of a coordinate."""
        base = self.declared.get(word)
        moves = base is not None and base.kind == "value" and base.name
        return WordMeaning("moving", symbol(form.format(moves))) if moves else None

    def parts(self, word: str) -> tuple[WordMeaning, ...]:
        """The factors of a word."""
        if len(word) > LONGEST_NAME:
            raise CheckError(f"a name of {len(word)} letters is too long")
        if word not in self.remembered:
            whole = self.meaning(word)
            self.remembered[word] = (whole,) if whole else self._split(word)
        return self.remembered[word]

    def _split(self, word: str) -> tuple[WordMeaning, ...]:
        ways: list[list[tuple[WordMeaning, ...]]] = [[()], *([] for _ in word)]
        for start in range(len(word)):
            for end in range(start + 1, len(word) + 1) if ways[start] else ():
                found = self._piece(word, start, end)
                if found is not None:
                    ways[end] = [*ways[end], *((*before, found) for before in ways[start])][:2]
        if len(ways[-1]) != 1:
            raise CheckError(f"`{word}` " + ("is a product in several ways" if ways[-1] else "is not declared"))
        return ways[-1][0]

    def _piece(self, word: str, start: int, end: int) -> WordMeaning | None:
        """The meaning of a part of a word; an index and a dot belong to the letter before them."""
        if not word[start].isalpha() or (end < len(word) and not word[end].isalpha()):
            return None
        found = self.meaning(word[start:end])
        number = found is not None and found.tree in (PI, EULER) and start > 0 and word[start:end].isascii()
        return None if number or found is None or found.kind == "operator" else found
