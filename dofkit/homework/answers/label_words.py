"""Reads labels (holonomic, scleronomic, bilateral) as people write them, with negations, in six languages."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import NamedTuple

from dofkit.base.errors import TextError
from dofkit.base.wording import closest
from dofkit.homework.answers.notation import Script, script_of
from dofkit.homework.answers.prose import DOUBTS, NO, listed, pattern, plain, rewriting, word_list, words
from dofkit.homework.answers.words import Word, one_text, split_words
from dofkit.homework.judgement import DoubtError, Given


class Terms(NamedTuple):
    """The word for a label (``holds``) and for its opposite (``fails``), and the spellings of each."""

    holds: str
    fails: str


def _forms(label: str) -> Iterator[str]:
    """Return stems with all endings: `scleronom` -> scleronomic, scleronome, scleronoma, ..."""
    for word in listed(f"label_words: {label}"):
        endings = ("", *listed("label_words: endings")) if word.endswith("*") else ("",)
        yield from (word.rstrip("*") + ending for ending in endings)


TERMS = {
    "holonomic": Terms("holonomic", "non-holonomic"),
    "scleronomic": Terms("scleronomic", "rheonomic"),
    "bilateral": Terms("bilateral", "unilateral"),
}
_WORDS: dict[str, tuple[str, bool]] = {
    word: (part, label == terms.holds) for part, terms in TERMS.items() for label in terms for word in _forms(label)
}
#: Labels that may be abbreviated, and the fewest letters of an abbreviation: `hol.`, `skl.`
_STEMS = ("holonom", "scleronom", "skleronom", "rheonom", "bilateral", "unilateral")
_FEWEST = 3
#: The spellings with which misspelt labels are compared.
_GUESSED = [w for w in _WORDS if w[:3] in ("hol", "scl", "skl", "rhe", "bil", "uni")]
_LONGEST = 24
_NEGATIONS = word_list("label_words: negations")
#: Words that may be between a negation and its label.
_FILLING = word_list("label_words: filling")
#: Words of other meanings that look like labels.
_OTHERS = frozenset({"integrable", "nonintegrable", "noncommutative", "nonlinear", "nonzero", "integrabel"})
#: The least similarity of a misspelt word and the label that is meant.
ALIKE = 0.86
_HYPHEN = re.compile("[-\u2010-\u2015_]")
_SLASH = re.compile(r"[/|+()\[\]]|(?<=[a-z])\.(?=[a-z])")
#: `holonomic: yes, scleronomic: no`, and `holonomic not`; `holonomic: yes and no` contradicts itself.
_TOLD = pattern("label_words: told")
_TOLD_TWICE = pattern("label_words: told twice")
#: A correction of a label; a negation in parentheses before a label.
_TAKEN_BACK = pattern("label_words: taken back")
#: `rheo-/scleronomic`: the ending is written once for two labels.
_SHORTENED = pattern("label_words: shortened")
#: Words that make a label ambiguous, but not a number.
_HALF_SAID = words("? half halb semi mezzo demi medio meio")
#: A negated group: it may mean that none or that not all are true.
_GROUP_DENIED = pattern("label_words: group denied")
_JOINED = pattern("label_words: joined")
#: What a negation without a label may be about: a reason near the label, such as integrability or time.
_REASONED = pattern("label_words: reasoned")
_BEFORE, _NEAR = 3, 6
#: A `no` before a whole sentence.
_REPLY = re.compile(r"\A\s*(?:no|nein|non|nao|não)\s*[,.;:!]", re.IGNORECASE)
#: A question without its mark: `is it holonomic`.
_ASKED = pattern("label_words: asked")
_ITALIAN_NOR = re.compile(r"\bné\b", re.IGNORECASE)
#: Phrases that mean a label.
_PHRASES = rewriting("label_words: phrases")
#: {label: {whether it is claimed to hold}} of the labels that are mentioned; both values for a contradiction.
Labels = Mapping[str, frozenset[bool]]
_HINT = "the labels are holonomic or non-holonomic, scleronomic or rheonomic, bilateral or unilateral"


def read_labels(answer: Given) -> Labels:
    """Return for each label in an answer whether it is claimed to hold; both values if the answer contradicts itself.

    A negation before a label, joined to it or not, inverts it; other words are ignored. Raises TextError if there is
    no label, or a word that may be one but cannot be read; DoubtError for questions and unclear negations.
    """
    labels: dict[str, frozenset[bool]] = {}
    negated, unread = False, None
    sequence = _split(answer)
    for place, word in enumerate(sequence):
        text = plain(word.text.strip(".:!()\"'"))
        if text in DOUBTS or text in _HALF_SAID or text.endswith("%"):
            raise DoubtError("a word makes the answer ambiguous.", word.column, _HINT)
        label = None if text in _OTHERS else _label(text.rstrip("?"))
        if label is not None:
            if text.endswith("?"):
                raise DoubtError("a question mark makes the answer ambiguous.", word.column, _HINT)
            part, holds = label
            labels[part] = labels.get(part, frozenset()) | {holds != negated}
        elif unread is None and "nom" in text and text not in _ORDINARY:
            unread = word
        if text in _NEGATIONS:
            negated = not negated
        elif label is not None or text not in _FILLING:
            if negated and label is None:
                _reasoned(sequence[max(place - _BEFORE, 0) : place + _NEAR])
            negated = False
    if labels and negated:
        raise DoubtError("it is not clear what is negated.", sequence[-1].column, _HINT)
    if unread is not None or not labels:
        message = f"'{unread.text[:40]}' is not a label" if unread is not None else "there is no label in this answer"
        raise TextError(message, unread.column if unread is not None else 1, _HINT)
    return labels


def _reasoned(following: list[Word]) -> None:
    """Raise DoubtError if these words around a negation contain no reason for a label (`_REASONED`)."""
    if _REASONED.search(" ".join(plain(w.text) for w in following)) is None:
        raise DoubtError("it is not clear what is negated.", following[0].column, _HINT)


_ORDINARY = frozenset({"nombre", "name", "phenomenon", "denominator"})


def _split(answer: Given) -> list[Word]:
    """Return the words of an answer, phrases replaced by labels. Raises DoubtError for questions and corrections."""
    if not isinstance(answer, str):
        return split_words(answer)
    script: Script = script_of(one_text(answer))
    if _ASKED.match(script.text):
        raise DoubtError("a question mark makes the answer ambiguous.", 1, _HINT)
    script = script.replaced(_REPLY, "")
    denied = _GROUP_DENIED.search(script.text) or _TAKEN_BACK.search(script.text)
    if denied is not None:
        raise DoubtError("it is not clear what is negated.", script.columns[denied.start()], _HINT)
    for both in _TOLD_TWICE.finditer(script.text):
        if (plain(both[1]) in NO) != (plain(both[2]) in NO):
            raise DoubtError("the answer says both yes and no.", script.columns[both.start()], _HINT)
    script = (
        script.replaced(_SHORTENED, lambda m: f"{m[1]}nom" if m[1] else f"{m[2]}lateral")
        .replaced(_TOLD, _answered)
        .replaced(_ITALIAN_NOR, "neither")
    )
    for phrase, by in _PHRASES:
        script = script.replaced(phrase, by)
    script = script.replaced(_SLASH, " ")
    separated = [Word(w.text, script.columns[w.column - 1]) for w in split_words(script.text)]
    return [Word(part, w.column) for w in separated for part in _parted(w.text)]


def _answered(match: re.Match[str]) -> str:
    """Return the replacement of a label with a reply (`holonomic: no` -> `not holonomic`)."""
    label, reply = match[1], plain(match[3])
    if _label(plain(label)) is None:
        return match[0]
    before = _JOINED.search(match.string[: match.start()])
    if reply in NO and before is not None and _label(plain(before[1])) is not None:
        raise DoubtError("it is not clear what is negated.", None, _HINT)
    return f"not {label}" if reply in NO else label


def _parted(text: str) -> list[str]:
    """Return the halves of two labels with a hyphen (`holonomic-scleronomic`), else the text alone."""
    halves = _HYPHEN.split(text)
    if len(halves) == 2 and all(_label(plain(part)) for part in halves):
        return halves
    return [text]


@lru_cache(maxsize=4096)
def _label(text: str) -> tuple[str, bool] | None:
    """Return (label, whether it is claimed to hold) for a word, even a misspelt one, or None."""
    bare = _HYPHEN.sub("", text)
    if bare in _WORDS:
        return _WORDS[bare]
    negated = next((n for n in ("non", "not", "nicht", "nao", "no", "an") if bare.startswith(n)), "")
    stem = bare[len(negated) :]
    near = next((whole for whole in _STEMS if len(stem) >= _FEWEST and whole.startswith(stem)), None)
    near = near or (closest(stem, _GUESSED, ALIKE) if len(stem) <= _LONGEST else None)
    if near is None:
        return None
    part, holds = _WORDS[near]
    return part, holds != bool(negated)


def mentions(part: str, answer: Given) -> bool:
    """Return whether an answer describes the label ``part`` in other words, such as `integrable` or `time`."""
    return isinstance(answer, str) and pattern(f"label_words: about {part}").search(plain(answer)) is not None


def word_of(part: str, holds: bool) -> str:
    """Return the word for a label that holds, or for its opposite."""
    return TERMS[part].holds if holds else TERMS[part].fails


def label_text(claims: Mapping[str, bool]) -> str:
    """Return the claimed labels as text, separated by commas."""
    return ", ".join(word_of(part, claims[part]) for part in TERMS if part in claims)
