"""A sentence with places for what differs, which can be told in several languages."""

from __future__ import annotations

from functools import cache
from importlib.resources import files
from typing import Literal, NamedTuple

from dofkit.base.documents import read_document

Language = Literal["en", "de", "fr", "es"]


@cache
def catalogue() -> dict[str, dict[str, str]]:
    """Language -> English sentence -> the same in this language."""
    data = files("dofkit.homework.sentences").joinpath("catalogue.yaml").read_bytes()
    rows: list[dict[str, str]] = read_document(data, "catalogue").value
    return {language: {row["en"]: row[language] for row in rows} for language in ("de", "fr", "es")}


class Said(NamedTuple):
    """``sentence``: in English, with names in braces for ``values``; those that are words are translated too."""

    sentence: str
    values: tuple[tuple[str, object], ...] = ()

    def told(self, language: Language = "en") -> str:
        """The sentence in a language; in English where it has none.

        >>> say("The answer is {number}.", number=3).told("de")
        'Die Antwort ist 3.'
        """
        known = {} if language == "en" else catalogue()[language]
        sentence = known.get(self.sentence, self.sentence)
        if not self.values:
            return sentence
        return sentence.format(**{name: _word(str(value), known) for name, value in self.values})


def _word(text: str, known: dict[str, str]) -> str:
    """A value, its words translated where all of them are known."""
    return ", ".join(known.get(word, word) for word in text.split(", "))


def say(sentence: str, **values: object) -> Said:
    """A sentence and what stands in its places."""
    return Said(sentence, tuple(values.items()))
