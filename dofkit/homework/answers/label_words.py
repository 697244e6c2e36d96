"""Reads labels (holonomic, scleronomic, bilateral) as people write them, with negations, in six languages."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import lru_cache
from typing import NamedTuple

from dofkit.base.errors import TextError
from dofkit.base.wording import closest
from dofkit.homework.answers.notation import Script, script_of
from dofkit.homework.answers.prose import DOUBTS, NO, YES, plain, word_list, words
from dofkit.homework.answers.words import Word, one_text, split_words
from dofkit.homework.judgement import DoubtError, Given


class Terms(NamedTuple):
    """The word for a label (``holds``) and for its opposite (``fails``), and the spellings of each."""

    holds: str
    fails: str
    positive: tuple[str, ...]
    negative: tuple[str, ...]


def _forms(*stems: str) -> tuple[str, ...]:
    """Return stems with all endings: `scleronom` -> scleronomic, scleronome, scleronoma, ..."""
    endings = ("", "ic", "ical", "ous", "e", "er", "es", "en", "em", "a", "o", "as", "os", "i", "ica", "ico", "isch")
    return tuple(stem + ending for stem in stems for ending in endings)


TERMS: dict[str, Terms] = {
    "holonomic": Terms(
        "holonomic", "non-holonomic", _forms("holonom", "olonom"),
        _forms("nonholonom", "anholonom", "nichtholonom", "unholonom", "anolonom", "inholonom"),
    ),
    "scleronomic": Terms(
        "scleronomic", "rheonomic",
        (*_forms("scleronom", "skleronom", "escleronom", "sclernom"), "timeindependent", "zeitunabhangig", "stationary",
         "stationar"),
        (*_forms("rheonom", "reonom", "nonscleronom"), "timedependent", "zeitabhangig", "instationar"),
    ),
    "bilateral": Terms(
        "bilateral", "unilateral",
        ("bilateral", "bilaterale", "bilateraux", "bilatero", "twosided", "doublesided", "zweiseitig",
         "beidseitig",
         "equality", "bilateralis", "bilaterales"),
        ("unilateral", "unilaterale", "unilatero", "onesided", "singlesided", "einseitig", "inequality",
         "nonbilateral",
         "unilaterales"),
    ),
}  # fmt: skip
_WORDS: dict[str, tuple[str, bool]] = {
    word: (part, holds)
    for part, terms in TERMS.items()
    for words, holds in ((terms.positive, True), (terms.negative, False))
    for word in words
}
#: Labels that may be abbreviated, and the fewest letters of an abbreviation: `hol.`, `skl.`
_STEMS = ("holonom", "scleronom", "skleronom", "rheonom", "bilateral", "unilateral")
_FEWEST = 3
#: The spellings with which misspelt labels are compared.
_GUESSED = [w for w in _WORDS if w[:3] in ("hol", "scl", "skl", "rhe", "bil", "uni")]
_LONGEST = 24
_NEGATIONS = word_list("label_words: negations")
#: Words that may be between a negation and its label.
_FILLING = word_list("label_words: filling")  # fmt: skip
#: Words of other meanings that look like labels.
_OTHERS = frozenset({"integrable", "nonintegrable", "noncommutative", "nonlinear", "nonzero", "integrabel"})
#: The least similarity of a misspelt word and the label that is meant.
ALIKE = 0.86
_HYPHEN = re.compile("[-\u2010-\u2015_]")
_SLASH = re.compile(r"[/|+()\[\]]|(?<=[a-z])\.(?=[a-z])")
_SAID = "|".join(sorted({*YES, *NO, "não", "sí", "sì"}))
_ENDS = r"\b(?=\s*(?:[,;.)\n]|$|(?:and|und|et|y|e)\s|[^\W\d_][\w-]*\s*[:=]))"
#: `holonomic: yes, scleronomic: no`, and `holonomic not`; `holonomic: yes and no` contradicts itself.
_TOLD = re.compile(rf"([^\W\d_][\w\u2010-\u2015-]*)(\s*[:=]\s*|\s+[-\u2013\u2014]?\s*)({_SAID}){_ENDS}", re.IGNORECASE)
_TOLD_TWICE = re.compile(
    rf"\b({_SAID})(?:\s*[,/&|]\s*|\s+(?:and|und|et|y|e|or|oder|ou|o)\s+|\s+)({_SAID}){_ENDS}", re.IGNORECASE
)
#: A correction of a label; a negation in parentheses before a label.
_TAKEN_BACK = re.compile(
    r"[,;]\s*(?:no|not|nope|nein|nicht|non|nao|não|wait|sorry)\s*[,;:!]"
    r"|\((?:no|not|non|nicht|nao|não|pas|ne|an|in|un|nicht)-?\)\s*-?(?=[^\W\d_])",
    re.IGNORECASE,
)
#: `rheo-/scleronomic`: the ending is written once for two labels.
_SHORTENED = re.compile(
    r"\b((?:non-?|nicht-?|an)?holo|(?:e?scler|skler)o|rh?eo)-(?=\s*(?:[/&]|(?:and|und|et|y|e|or|oder|ou|o)\s))"
    r"|\b(bi|uni)-(?=\s*(?:[/&]|(?:and|und|et|y|e|or|oder|ou|o)\s))",
    re.IGNORECASE,
)
#: Words that make a label ambiguous, but not a number.
_HALF_SAID = words("? half halb semi mezzo demi medio meio")
#: A negated group: it may mean that none or that not all are true.
_GROUP_DENIED = re.compile(r"\b(?:not|nicht|non|no|pas|nao|não)\s*\([^()]*\w[\s,&]+\w[^()]*\)", re.IGNORECASE)
_JOINED = re.compile(r"([^\W\d_][\w\u2010-\u2015-]*)\s*(?:[/&+]|\b(?:and|und|et|y|e|or|oder|ou)\b)\s*\Z", re.IGNORECASE)
#: What a negation without a label may be about: a reason near the label, such as integrability or time.
_REASONED = re.compile(
    r"integr|time|zeit|temps|tiempo|tempo|veloc|geschwind|vitess|depend|abhang|explici|explizi|side|seitig|(?<!')\bt\b"
)
_BEFORE, _NEAR = 3, 6
#: A `no` before a whole sentence.
_REPLY = re.compile(r"\A\s*(?:no|nein|non|nao|não)\s*[,.;:!]", re.IGNORECASE)
#: A question without its mark: `is it holonomic`.
_ASKED = re.compile(
    r"\s*(?:(?:is|are|was)\s+(?:it|this|that|the|they)|ist\s+(?:es|sie|das|die)|est-(?:ce|elle|il)|es\s+esta|é\s+esta)\b",
    re.IGNORECASE,
)
_ITALIAN_NOR = re.compile(r"\bné\b", re.IGNORECASE)
_TIMELESS, _TIMED = " timeindependent ", " timedependent "
#: Phrases that mean a label.
_PHRASES = tuple(
    (re.compile(pattern, re.IGNORECASE), by)
    for pattern, by in (
        (r"\b(?:does|do|is|are)\s*(?:not|n't)\s+(?:explicitly\s+)?depend(?:ent)?\s+(?:explicitly\s+)?(?:on|of)\s+"
         r"(?:the\s+)?time\b", _TIMELESS),
        (r"\b(?:doesn't|does\s+not|no)\s+(?:contain|involve|explicit)\s+(?:the\s+)?(?:time|t)\b(?:\s+dependence)?",
         _TIMELESS),
        (r"\bdepend(?:s|ent|ing)?\s+(?:explicitly\s+)?(?:on|of)\s+(?:the\s+)?time\b", _TIMED),
        (r"\btime[\s-]+independent\b|\bindependent\s+of\s+(?:the\s+)?time\b|\bunabh[aä]ngig\s+von\s+der\s+zeit\b",
         _TIMELESS),
        (r"\btime[\s-]+dependent\b", _TIMED),
        (r"\bexplicit(?:ly)?\s+time[\s-]+(?:dependence|dependent)\b", _TIMED),
        (r"\b(one|two|single|double)[\s-]+sided\b", r" \1sided "),
        (r"\bh[aä]ngt\s+nicht\s+(?:explizit\s+)?von\s+der\s+zeit\s+ab\b", _TIMELESS),
        (r"\bh[aä]ngt\s+(?:explizit\s+)?von\s+der\s+zeit\s+ab\b", _TIMED),
        (r"\bne\s+d[ée]pend\s+pas\s+(?:explicitement\s+)?du\s+temps\b|\bind[ée]pendante?\s+du\s+temps\b", _TIMELESS),
        (r"\bd[ée]pend(?:ante?)?\s+(?:explicitement\s+)?du\s+temps\b", _TIMED),
        (r"\bno\s+depende\s+(?:expl[ií]citamente\s+)?del\s+tiempo\b|\bindependiente\s+del\s+tiempo\b", _TIMELESS),
        (r"\bdepende\s+(?:expl[ií]citamente\s+)?del\s+tiempo\b|\bdependiente\s+del\s+tiempo\b", _TIMED),
    )
)  # fmt: skip
_ABOUT = {
    "holonomic": re.compile(r"integr"),
    "scleronomic": re.compile(r"\btime|zeit|temps|tiempo|tempo\b"),
    "bilateral": re.compile(r"\bside|seitig|\bcote|\blado|\blato"),
}
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
    for pattern, by in _PHRASES:
        script = script.replaced(pattern, by)
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
    return isinstance(answer, str) and _ABOUT[part].search(plain(answer)) is not None


def word_of(part: str, holds: bool) -> str:
    """Return the word for a label that holds, or for its opposite."""
    return TERMS[part].holds if holds else TERMS[part].fails


def label_text(claims: Mapping[str, bool]) -> str:
    """Return the claimed labels as text, separated by commas."""
    return ", ".join(word_of(part, claims[part]) for part in TERMS if part in claims)
