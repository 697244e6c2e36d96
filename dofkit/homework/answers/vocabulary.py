"""The words of an answer: those that are declared, and what one that is not can stand for."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from dofkit.base.errors import TextError
from dofkit.expressions.text import Names, spelled
from dofkit.expressions.text.characters import GREEK
from dofkit.expressions.text.names import in_words, unmarked
from dofkit.expressions.text.tokens import read_word
from dofkit.expressions.tree import E, Expr, coordinate, parameter
from dofkit.homework.answers.declared import usual_name
from dofkit.homework.answers.prose import pattern

#: Names of its own in an answer.
MOST_OWN = 8
_OWN = pattern("vocabulary: own")
_CARTESIAN = frozenset("xyzXYZ")
_LONG = frozenset({*GREEK.values(), "varphi", "vartheta"})
_RATE = re.compile(r"(.+?)_?d?dot([_0-9]\w*)?")
#: Words that are one name, never a product.
_WHOLE = re.compile(r"const|konst|cst|cte|lam|mu|mult", re.IGNORECASE)


@dataclass(frozen=True)
class AnswerNames:
    """The declared names, those that the answer introduces (``undeclared``), and other spellings (``meant``).

    ``choice``: {kind of ambiguity: number of the reading}, the same in the whole answer; ``signs_apart``: whether `±`
    makes two readings, not one product. ``usual``: words read as usual names of quantities, such as `v_x`;
    ``frequencies``: whether omega may also be a frequency.
    """

    names: Names
    undeclared: tuple[str, ...] = ()
    moving: frozenset[str] = frozenset()
    meant: Mapping[str, str] = field(default_factory=dict)
    places: Mapping[str, int] = field(default_factory=dict)
    choice: Mapping[str, int] = field(default_factory=dict)
    accelerations: bool = False
    signs_apart: bool = False
    euler: bool = False
    usual: Mapping[str, Expr] = field(default_factory=dict)
    rank: int = 0
    frequencies: bool = False

    def as_names(self) -> Names:
        """Return the names for the parser; with ``euler``, `e` is Euler's number."""
        base = self.names
        more: dict[str, Expr] = {**({"e": E} if self.euler else {}), **self.usual}
        for word, name in self.meant.items():
            more[word] = coordinate(name) if name in base.coordinates else base.parameters[name]
        more.update({name: parameter(name) for name in self.undeclared if name not in self.moving})
        return Names(
            base.coordinates | self.moving,
            {**base.parameters, **more},
            base.functions,
            base.arguments,
            base.allow_time,
            base.allow_velocities,
            self.accelerations,
        )

    def declares(self, word: str) -> bool:
        """Return whether a word has a meaning already."""
        return (
            (self.euler and word == "e")
            or word in self.undeclared
            or word in self.usual
            or self.names.lookup.meaning(word) is not None
        )

    def with_word(self, word: str) -> AnswerNames | None:
        """Return the vocabulary extended by a meaning of an unknown word, or None if it cannot have one."""
        word = in_words(word)
        if word == "e" and not self.euler:
            return replace(self, euler=True)
        rate = _RATE.fullmatch(word)
        stem = rate[1] + (rate[2] or "") if rate else word[1:] if word[0] == "d" and len(word) > 1 else ""
        if stem and stem in self.undeclared and stem not in self.moving:
            return replace(self, moving=self.moving | {stem})
        twin = self._twin(word) or (stem and self._twin(stem))
        if twin and word not in self.meant:
            return replace(self, meant={**self.meant, (word if self._twin(word) else stem): twin})
        names = replace(self.names, allow_accelerations=self.accelerations)
        quantity = None if word in self.usual else usual_name(word, names)
        if quantity is not None:
            return replace(self, usual={**self.usual, word: quantity})
        if len(self.undeclared) == MOST_OWN:
            return None
        letter = self._letter(word)
        if letter is not None:
            return letter
        if stem and rate is not None and self._may_be_own(stem):
            return replace(self, undeclared=(*self.undeclared, stem), moving=self.moving | {stem})
        if stem and self._may_be_own(stem) and spelled(stem) in _LONG:
            return replace(self, undeclared=(*self.undeclared, stem), moving=self.moving | {stem})
        return replace(self, undeclared=(*self.undeclared, word)) if self._may_be_own(word) else None

    def _twin(self, word: str) -> str | None:
        """Return the only declared name that differs in case and `_`, or the only coordinate `word_...`, or None."""
        declared = (*self.names.coordinates, *self.names.parameters)
        twins = {name for name in declared if unmarked(name) == unmarked(word)}
        twins = twins or {name for name in self.names.coordinates if name.partition("_")[0] == word}
        return twins.pop() if len(twins) == 1 else None

    def _may_be_own(self, word: str) -> bool:
        """Return whether an answer may introduce this short name; not x, y, z, nor ``x_A`` if x is declared."""
        if word in _CARTESIAN:
            return False
        stem, _, index = word.partition("_")
        if word != (bare := word.rstrip("123456789")) and spelled(bare) in self.names.coordinates:
            return False
        declared = stem in self.names.coordinates or stem in self.names.parameters
        fits = bool(_OWN.fullmatch(word)) or spelled(stem).rstrip("0123456789") in _LONG
        return fits and not (declared and index and not index.isdigit())

    def _letter(self, word: str) -> AnswerNames | None:
        """Return the vocabulary with the only undeclared letter of a product: `Cx` is C x; None if there is not one."""
        if len(word) < 2 or spelled(word) in _LONG or "_" in word or _WHOLE.match(word):
            return None
        candidates = []
        for base in (self, replace(self, euler="e" in word or self.euler)):
            for letter in dict.fromkeys(["", *(c for c in word if c.isalpha() and not base.declares(c))]):
                grown = base.with_word(letter) if letter else base
                if grown is None:
                    continue
                try:
                    read_word(word, grown.as_names().lookup, 1, False)
                except TextError:
                    continue
                candidates.append(grown)
            if candidates:
                break
        return candidates[0] if len(candidates) == 1 else None
