"""Feedback for students, in English, German, French and Spanish: sentences with placeholders for values."""

from __future__ import annotations

import re
from functools import cache
from importlib.resources import files
from typing import Literal, NamedTuple

from dofkit.base.documents import read_document

Language = Literal["en", "de", "fr", "es"]


@cache
def _rows(name: str) -> list[dict[str, str]]:
    data = files("dofkit.homework.sentences").joinpath(name).read_bytes()
    rows: list[dict[str, str]] = read_document(data, name).value
    return rows


@cache
def catalogue() -> dict[str, dict[str, str]]:
    """Return {language: {English sentence: its translation}}."""
    return {language: {row["en"]: row[language] for row in _rows("catalogue.yaml")} for language in ("de", "fr", "es")}


@cache
def meanings() -> dict[str, str]:
    """Return {feedback code: English sentence that explains it}."""
    return {code: row["en"] for row in _rows("catalogue.yaml") if "code" in row for code in row["code"].split()}


@cache
def _reading(language: Language) -> list[tuple[re.Pattern[str], str]]:
    """Return (pattern of an English message about unreadable answers, its translation)."""
    return [(_pattern(row["en"]), row[language]) for row in _rows("reading.yaml")]


def _pattern(sentence: str) -> re.Pattern[str]:
    pieces = _PLACE.split(sentence)
    return re.compile(
        "".join(re.escape(part) if i % 2 == 0 else f"(?P<{part}>.+?)" for i, part in enumerate(pieces)), re.DOTALL
    )


_PLACE = re.compile(r"\{(\w+)\}")


def stopped(text: str, language: Language) -> str:
    """Return the translation of a message about an unreadable answer, or the English text if there is none.

    >>> stopped("`q` is not declared", "fr")
    "`q` n'est pas déclaré"
    """
    for pattern, translation in _reading(language) if language != "en" else ():
        match = pattern.fullmatch(text)
        if match is not None:
            return translation.format(**match.groupdict())
    return text


@cache
def _scene_words(language: Language) -> dict[str, str]:
    return {row["en"]: row[language] for row in _rows("scene_words.yaml")}


def described(text: str, language: Language) -> str:
    """Return the description of a constraint or a force in a language.

    >>> described("link (0, 0)-A, length l", "de")
    'Stab (0, 0)-A, Länge l'
    """
    words = _scene_words(language)
    types = "|".join(re.escape(word) for word in words if not word.endswith(" "))
    joining = "|".join(re.escape(word) for word in words if word.endswith(" "))
    return re.sub(rf"\A(?:{types})\b|{joining}", lambda match: words[match[0]], text)


#: The placeholders of sentences for messages about unreadable answers.
FAULTS = frozenset({"fault", "hint"})


class Said(NamedTuple):
    """A sentence in English with placeholders for ``values``, of which known words are translated too."""

    sentence: str
    values: tuple[tuple[str, object], ...] = ()

    def translated(self, language: Language = "en") -> str:
        """Return the sentence in a language, or in English if there is no translation.

        >>> say("The correct answer is {number}.", number=3).translated("de")
        'Die richtige Antwort ist 3.'
        """
        translations = {} if language == "en" else catalogue()[language]
        sentence = translations.get(self.sentence, self.sentence)
        if not self.values:
            return sentence
        return sentence.format(
            **{n: stopped(str(v), language) if n in FAULTS else _word(str(v), translations) for n, v in self.values}
        )


def _word(text: str, translations: dict[str, str]) -> str:
    """Return a value with all known words translated."""
    return "".join(translations.get(word, word) for word in re.split("(, | / )", text))


def in_language(language: Language, sentence: str, **values: object) -> str:
    """Return a sentence of the catalogue in a language, with values in its placeholders.

    >>> in_language("de", "{score} of {most}", score=1, most=2)
    '1 von 2'
    """
    return say(sentence, **values).translated(language)


def say(sentence: str, **values: object) -> Said:
    """Return a sentence with the values of its placeholders."""
    return Said(sentence, tuple(values.items()))
