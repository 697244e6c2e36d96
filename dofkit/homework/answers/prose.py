"""Word lists for texts of answers, in English, German, French, Spanish, Italian and Portuguese."""

from __future__ import annotations

import re
import unicodedata
from functools import cache, lru_cache
from importlib.resources import files

from dofkit.base.documents import read_document

_MARKS = re.compile("[\u0300-\u036f]")


def words(text: str) -> frozenset[str]:
    """Return the set of the words of a text."""
    return frozenset(text.split())


@cache
def _word_lists() -> dict[str, str]:
    data = files("dofkit.homework.answers").joinpath("words.yaml").read_bytes()
    lists: dict[str, str] = read_document(data, "words").value
    return lists


def word_list(name: str) -> frozenset[str]:
    """Return the words or phrases of a list in `words.yaml`."""
    text = _word_lists()[name]
    return frozenset(text.split("|")) if "|" in text else words(text)


@lru_cache(maxsize=4096)
def plain(text: str) -> str:
    """Return a text in lower case, without accents, blanks around it and the full stop at its end.

    >>> plain(" Non intégrable. ")
    'non integrable'
    """
    bare = _MARKS.sub("", unicodedata.normalize("NFD", text.strip().lower().replace("’", "'")))
    return " ".join(bare.rstrip(".!").split())


#: Whole numbers in words; masculine, feminine and counted forms.
NUMBERS: dict[str, int] = {
    plain(word): n
    for n, forms in enumerate((
        "zero null zéro cero nil", "one ein eins eine einen einer eines un une uno una um uma single",
        "two zwei deux dos due dois duas", "three drei trois tres tre três", "four vier quatre cuatro quattro quatro",
        "five fünf fuenf cinq cinco cinque", "six sechs seis sei", "seven sieben sept siete sette sete",
        "eight acht huit ocho otto oito", "nine neun neuf nueve nove", "ten zehn dix diez dieci dez",
        "eleven elf onze once undici", "twelve zwölf zwoelf douze doce dodici doze",
    ))
    for word in forms.split()
}  # fmt: skip
#: Nouns of counted quantities: a number of constraints is not a number of degrees of freedom.
CONSTRAINT_NOUNS = word_list("constraint_nouns")
FREEDOM_NOUNS = word_list("freedom_nouns")
#: All nouns of counted quantities.
UNITS = word_list("units") | CONSTRAINT_NOUNS | FREEDOM_NOUNS
#: Words that lead to a number.
LEADING = word_list("leading")
#: Words before a reason, which is ignored.
REASONS = re.compile(
    r"\b(?:because|since|as there|due to|weil|da|denn|wegen|car|parce que|puisque|porque|ya que|pues|perche|perché|"
    r"poiche|poiché|pois|já que)\b",
    re.IGNORECASE,
)
#: Words that negate a statement.
NEGATIONS = words("not no nicht kein keine pas nao não non never isn't")
#: Words that question an answer.
DOUBTS = word_list("doubts")
#: Words that question the answer in a remark of at most `_DOUBTFUL_WORDS` words; phrases that do so in any remark.
_TAKING_BACK = word_list("taking_back")
_DOUBTFUL_WORDS = 3
_UNSURE = re.compile(
    r"\b(?:not|nicht|pas|no|non|nao)\s+(?:quite\s+|ganz\s+)?(?:sure?|certain|sicher|segur[oa]|sicur[oa]|cert[oa])\b"
)
#: Words before a conclusion.
CONCLUSION = re.compile(
    r"(?:[.,;]|\s)\s*(?:so|therefore|hence|thus|donc|luego|quindi|portanto|daher|folglich)\b\s*:?\s*(?=\S)",
    re.IGNORECASE,
)
#: Replies after a word such as `holonomic:`.
YES = words("yes true ja wahr oui vrai si sim vero verdadero verdadera verdadeiro")
NO = words("no false not nein falsch nicht non faux falso falsa nao")
#: Texts that are no answer.
NOTHING_SAID = frozenset(
    ("", "-", "--", "---", "–", "—", "−", "/", "?", "??", "???", "...", "…", "n/a", "na", "x?", ".")
)
#: Words without meaning for the answer.
FILLING = word_list("filling")


def takes_back(remark: str) -> bool:
    """Return whether a short remark questions what precedes it: `?`, `not sure`, `maybe 2`.

    >>> takes_back("not sure"), takes_back("it would be 2 without the rod")
    (True, False)
    """
    remark_words = re.findall(r"[^\W\d_]+(?:['’-][^\W\d_]+)*", plain(remark))
    doubted = len(remark_words) <= _DOUBTFUL_WORDS and not _TAKING_BACK.isdisjoint(remark_words)
    return "?" in remark or doubted or _UNSURE.search(plain(remark)) is not None


def says_nothing(answer: object) -> bool:
    """Return whether a text is no answer: empty, a dash, or a question mark."""
    return isinstance(answer, str) and answer.strip().lower() in NOTHING_SAID
