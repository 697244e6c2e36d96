"""The label of a constraint: holonomic or not, scleronomic or rheonomic, bilateral or unilateral."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from dofkit.base.errors import Fault
from dofkit.homework.answers.label_words import TERMS, label_text, mentions, read_labels, word_of
from dofkit.homework.judgement import Given, Judgement, Sentence, needs_review, partly
from dofkit.homework.key.key import Key
from dofkit.homework.key.misconceptions import explain_label
from dofkit.homework.questions.base import Earlier, QuestionBase
from dofkit.homework.sentences.said import Said, say
from dofkit.report import ConstraintEntry
from dofkit.scene.fields import Listed, suggestion

Part = Literal["holonomic", "scleronomic", "bilateral"]


class LabelQuestion(QuestionBase):
    """Words in any order; each part that is asked for counts the same."""

    wanted: ClassVar[str] = "Which of these labels does the constraint {about} have: {parts}?"
    how: ClassVar[str] = (
        "Labels are words: holonomic or non-holonomic, scleronomic or rheonomic, bilateral or unilateral; in any order."
    )
    examples: ClassVar[tuple[str, ...]] = (
        "non-holonomic, rheonomic",
        "holonomic, rheonomic",
        "non-holonomic, scleronomic",
        "holonomic, scleronomic",
    )
    ask: Literal["label"] = Field(description="the labels of a constraint")
    constraint: str = Field(description="the name of the constraint")
    parts: Annotated[tuple[Part, ...], Listed, Field(min_length=1)] = Field(
        ("holonomic", "scleronomic"), description="which labels are asked for"
    )

    def faults(self, key: Key) -> Iterator[Fault]:
        if self.constraint not in key.constraints:
            hint = suggestion(self.constraint, list(key.constraints), "constraints")
            yield Fault(f"the scene has no constraint '{self.constraint}'", ("constraint",), hint=hint)

    def asked(self, about: str) -> Said:
        return say(self.wanted, about=about, parts=", ".join(f"{TERMS[p].holds}, {TERMS[p].fails}" for p in self.parts))

    def read(self, answer: Given, key: Key) -> str:
        del key
        return label_text(read_labels(answer))

    def reveals(self, found: Judgement) -> bool:
        return found.status in ("right", "needs_review")

    def solution(self, key: Key) -> Sentence:
        truth = truths(key.constraints[self.constraint])
        known = [word_of(p, holds) for p in self.parts if (holds := truth[p]) is not None]
        reason = key.constraints[self.constraint].reason
        return say("It is {labels}: {reason}", labels=", ".join(known), reason=reason) if known else ""

    def judge(self, answer: Given, key: Key, earlier: Earlier) -> Judgement:
        del earlier
        given, entry = read_labels(answer), key.constraints[self.constraint]
        truth, shown = truths(entry), label_text(given)
        if any(truth[p] is None for p in self.parts):
            return needs_review(shown, "dofkit does not know the label for certain.")
        good = [p for p in self.parts if given.get(p) == frozenset({truth[p]})]
        missing = [p for p in self.parts if p not in given]
        hinted = [p for p in missing if mentions(p, answer)]
        if hinted:
            return needs_review(shown, "it says something of a part without its label.")
        twice = [p for p in self.parts if len(given.get(p, ())) > 1]
        codes: list[str] = []
        told: list[Sentence] = []
        for p in self.parts:
            if p not in good and p not in missing and p not in twice:
                code, why = explain_label(p, entry, key)
                codes.append(code)
                told.append(why)
        told += [
            say("You did not say whether it is {holds} or {fails}.", holds=TERMS[p].holds, fails=TERMS[p].fails)
            for p in missing
        ]
        told += [
            say("It cannot be both {holds} and {fails}.", holds=TERMS[p].holds, fails=TERMS[p].fails) for p in twice
        ]
        return partly(Fraction(len(good), len(self.parts)), shown, "", *codes).saying(*told)


def truths(entry: ConstraintEntry) -> dict[str, bool | None]:
    """What holds of a constraint, by part."""
    return {"holonomic": entry.holonomic, "scleronomic": entry.scleronomic, "bilateral": entry.bilateral}
