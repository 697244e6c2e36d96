"""Questions for the labels of a constraint: (non-)holonomic, scleronomic or rheonomic, bilateral or unilateral."""

from __future__ import annotations

from fractions import Fraction
from itertools import product
from typing import Annotated, Literal

from pydantic import Field

from dofkit.homework.answers.declared import DeclaredNames
from dofkit.homework.answers.label_words import TERMS, label_text, mentions, read_labels, word_of
from dofkit.homework.judgement import DoubtError, Given, Judgement, Reading, Sentence, needs_review, partly
from dofkit.homework.key.key import Key
from dofkit.homework.key.misconceptions import explain_label
from dofkit.homework.questions.base import Earlier, QuestionBase
from dofkit.homework.sentences import Said, meanings, say
from dofkit.report import ConstraintEntry
from dofkit.scene.fields import Listed

Part = Literal["holonomic", "scleronomic", "bilateral"]


class LabelQuestion(QuestionBase):
    """Labels in any order; each of the ``parts`` has the same share of the points."""

    ask: Literal["label"] = Field(description="the classification of a constraint")
    constraint: str = Field(description="the name of the constraint")
    parts: Annotated[tuple[Part, ...], Listed, Field(min_length=1)] = Field(
        ("holonomic", "scleronomic"), description="which parts of the classification are asked for"
    )

    def _asked(self, about: str) -> Said:
        pairs = ", ".join(f"{TERMS[p].holds} / {TERMS[p].fails}" for p in self.parts)
        return say(self.words().wanted, about=about, parts=pairs)

    def readings(self, answer: Given, names: DeclaredNames) -> list[Reading]:
        """Return all sets of labels that the answer may state; DoubtError if a property is described but not named."""
        del names
        labels = read_labels(answer)
        hinted = [p for p in self.parts if p not in labels and mentions(p, answer)]
        if hinted:
            raise DoubtError("a property is described but not named.", 1, None)
        choices = product(*([(p, holds) for holds in sorted(labels[p], reverse=True)] for p in TERMS if p in labels))
        return [Reading(dict(holding), label_text(dict(holding))) for holding in choices]

    def solution(self, key: Key) -> Sentence:
        truth = truths(key.constraints[self.constraint])
        words = [word_of(p, holds) for p in self.parts if (holds := truth[p]) is not None]
        reason = key.constraints[self.constraint].reason
        return say("The constraint is {labels}. {reason}", labels=", ".join(words), reason=reason) if words else ""

    def judged(self, reading: Reading, key: Key, earlier: Earlier) -> Judgement:
        del earlier
        claims, entry, text = reading.value, key.constraints[self.constraint], reading.text
        truth = truths(entry)
        if any(truth[p] is None for p in self.parts):
            return needs_review(text, "the classification of this constraint is not known for certain.")
        good = [p for p in self.parts if claims.get(p) is truth[p]]
        missing = [p for p in self.parts if p not in claims]
        explained = [explain_label(p, entry) for p in self.parts if p not in good and p not in missing]
        hints: list[Sentence] = [why or meanings()[code] for code, why in explained]
        hints += [
            say("State also whether it is {holds} or {fails}.", holds=TERMS[p].holds, fails=TERMS[p].fails)
            for p in missing
        ]
        codes, share = [code for code, _ in explained], Fraction(len(good), len(self.parts))
        return partly(share, text, *codes, why=hints[0] if hints else "").saying(*hints[1:])


def truths(entry: ConstraintEntry) -> dict[str, bool | None]:
    """Return {part: whether the label holds, or None if undecided} of a constraint."""
    return {"holonomic": entry.holonomic, "scleronomic": entry.scleronomic, "bilateral": entry.bilateral}
