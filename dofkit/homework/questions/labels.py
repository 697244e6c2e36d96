"""The label of a constraint: holonomic or not, scleronomic or rheonomic, bilateral or unilateral."""

from __future__ import annotations

import re
from collections.abc import Iterator
from fractions import Fraction
from typing import Annotated, Literal, NamedTuple

from pydantic import Field

from dofkit.base.errors import Fault, TextError
from dofkit.base.spelling import closest
from dofkit.homework.answers.words import split_words
from dofkit.homework.judgement import Given, Judgement, needs_review, partly
from dofkit.homework.key.key import Key
from dofkit.homework.key.misconceptions import explain_label
from dofkit.homework.questions.base import Earlier, QuestionBase
from dofkit.report import ConstraintEntry
from dofkit.scene.fields import Listed, suggestion

Part = Literal["holonomic", "scleronomic", "bilateral"]


class Terms(NamedTuple):
    """What a part is called where it holds, and where it does not, each with what people write for it."""

    holds: str
    fails: str
    positive: tuple[str, ...]
    negative: tuple[str, ...]


TERMS: dict[str, Terms] = {
    "holonomic": Terms(
        "holonomic", "non-holonomic", ("holonomic", "holonom"), ("nonholonomic", "anholonomic", "nichtholonom")
    ),
    "scleronomic": Terms(
        "scleronomic",
        "rheonomic",
        ("scleronomic", "scleronomous", "skleronom", "skleronomic", "timeindependent"),
        ("rheonomic", "rheonomous", "rheonom", "nonscleronomic", "timedependent"),
    ),
    "bilateral": Terms(
        "bilateral",
        "unilateral",
        ("bilateral", "twosided", "equality"),
        ("unilateral", "onesided", "inequality", "nonbilateral"),
    ),
}
_WORDS: dict[str, tuple[str, bool]] = {
    word: (part, holds)
    for part, terms in TERMS.items()
    for words, holds in ((terms.positive, True), (terms.negative, False))
    for word in words
}
_NEGATIONS = frozenset(
    {"not", "non", "no", "non-", "not-", "isn't", "isnt", "nicht", "kein", "never", "neither", "nor"}
)
#: Words over which a negation reaches.
_FILLING = frozenset({"a", "an", "the", "is", "it", "be", "also", "really"})
#: Words of other meanings that look like labels.
_OTHERS = frozenset({"integrable", "nonintegrable", "noncommutative", "nonlinear", "nonzero"})
#: How alike a misspelt word and the label that is meant are.
ALIKE = 0.86
_HYPHEN = re.compile("[-\u2010-\u2015_]")


class LabelQuestion(QuestionBase):
    """Words in any order; each part that is asked for counts the same."""

    ask: Literal["label"] = Field(description="the labels of a constraint")
    constraint: str = Field(description="the name of the constraint")
    parts: Annotated[tuple[Part, ...], Listed, Field(min_length=1)] = Field(
        ("holonomic", "scleronomic"), description="which labels are asked for"
    )

    def faults(self, key: Key) -> Iterator[Fault]:
        if self.constraint not in key.constraints:
            hint = suggestion(self.constraint, list(key.constraints), "constraints")
            yield Fault(f"the scene has no constraint '{self.constraint}'", ("constraint",), hint=hint)

    def read(self, answer: Given, key: Key) -> str:
        del key
        return _label_text(read_labels(answer))

    def solution(self, key: Key) -> str:
        truth = truths(key.constraints[self.constraint])
        known = [_word(p, holds) for p in self.parts if (holds := truth[p]) is not None]
        return f"It is {', '.join(known)}: {key.constraints[self.constraint].reason}" if known else ""

    def judge(self, answer: Given, key: Key, earlier: Earlier) -> Judgement:
        del earlier
        given, entry = read_labels(answer), key.constraints[self.constraint]
        truth, shown = truths(entry), _label_text(given)
        if any(truth[p] is None for p in self.parts):
            return needs_review(shown, "dofkit does not know the label for certain.")
        good = [p for p in self.parts if given.get(p) == frozenset({truth[p]})]
        missing = [p for p in self.parts if p not in given]
        twice = [p for p in self.parts if len(given.get(p, ())) > 1]
        codes: list[str] = []
        told: list[str] = []
        for p in self.parts:
            if p not in good and p not in missing and p not in twice:
                code, why = explain_label(p, entry, key)
                codes.append(code)
                told.append(why)
        told += [f"You did not say whether it is {TERMS[p].holds} or {TERMS[p].fails}." for p in missing]
        told += [f"It cannot be both {TERMS[p].holds} and {TERMS[p].fails}." for p in twice]
        return partly(Fraction(len(good), len(self.parts)), shown, " ".join(told), *codes)


def truths(entry: ConstraintEntry) -> dict[str, bool | None]:
    """What holds of a constraint, by part."""
    return {"holonomic": entry.holonomic, "scleronomic": entry.scleronomic, "bilateral": entry.bilateral}


def read_labels(answer: Given) -> dict[str, frozenset[bool]]:
    """For every part that is mentioned whether it is said to hold; both where the answer contradicts itself.

    A negation before a label, joined to it or not, turns it round; what else a sentence says is read over. Raises
    TextError where there is no label, or a word that may be one and cannot be read.
    """
    found: dict[str, frozenset[bool]] = {}
    negated, unread = False, None
    for word in split_words(answer):
        text = word.text.strip(".:!()\"'").lower()
        label = None if text in _OTHERS else _label(text)
        if label is not None:
            part, holds = label
            found[part] = found.get(part, frozenset()) | {holds != negated}
        elif unread is None and "nom" in text:
            unread = word
        if text in _NEGATIONS:
            negated = not negated
        elif label is not None or text not in _FILLING:
            negated = False
    if unread is not None or not found:
        hint = "the labels are holonomic or non-holonomic, scleronomic or rheonomic, bilateral or unilateral"
        told = f"'{unread.text[:40]}' is no label" if unread is not None else "there is no label in this answer"
        raise TextError(told, unread.column if unread is not None else 1, hint)
    return found


def _label(text: str) -> tuple[str, bool] | None:
    """The part that a word names and whether it says that it holds; misspelt labels are read too."""
    plain = _HYPHEN.sub("", text)
    if plain in _WORDS:
        return _WORDS[plain]
    negated = next((n for n in ("non", "not", "nicht") if plain.startswith(n)), "")
    rest = plain[len(negated) :]
    near = closest(rest, [w for w in _WORDS if not w.startswith("n")], ALIKE)
    if near is None:
        return None
    part, holds = _WORDS[near]
    return part, holds != bool(negated)


def _word(part: str, holds: bool) -> str:
    return TERMS[part].holds if holds else TERMS[part].fails


def _label_text(given: dict[str, frozenset[bool]]) -> str:
    return ", ".join(_word(part, holds) for part in TERMS for holds in sorted(given.get(part, ()), reverse=True))
