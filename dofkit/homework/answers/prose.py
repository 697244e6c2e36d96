"""The words around an answer, in English, German, French, Spanish, Italian and Portuguese."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Mapping
from functools import lru_cache

from dofkit.base.documents import package_table

#: What replaces a match: a template, or a function.
Rewriting = str | Callable[[re.Match[str]], str]
_MARKS = re.compile("[\u0300-\u036f]")
_FRAGMENT = re.compile(r"<([A-Z_\d]+)>")


def words(text: str) -> frozenset[str]:
    """The words of a text, as a set."""
    return frozenset(text.split())


def listed(name: str) -> list[str]:
    """Return a list of `words.yaml` in its order."""
    text: str = package_table(__package__, "words.yaml")[name]
    return text.split("|" if "|" in text else None)


def word_list(name: str) -> frozenset[str]:
    """Return a list of `words.yaml`."""
    return frozenset(listed(name))


def pattern(name: str) -> re.Pattern[str]:
    """Return a pattern of `patterns.yaml`."""
    return _compiled(package_table(__package__, "patterns.yaml")[name])


def rewriting(name: str, computed: Mapping[str, Rewriting] = {}) -> tuple[tuple[re.Pattern[str], Rewriting], ...]:
    """Return patterns of `patterns.yaml`, each with what replaces a match; ``computed``: the functions that do."""
    rows = package_table(__package__, "patterns.yaml")[name]
    return tuple((_compiled(row["pattern"]), row["by"] if "by" in row else computed[row["computed"]]) for row in rows)


def _compiled(text: str) -> re.Pattern[str]:
    fragments = package_table(__package__, "patterns.yaml")["fragments"]
    while (place := _FRAGMENT.search(text)) is not None:
        text = text.replace(place[0], fragments[place[1]])
    return re.compile("".join(text.splitlines()))


@lru_cache(maxsize=4096)
def plain(text: str) -> str:
    """A text in small letters, without accents, blanks around it and the stop at its end.

    >>> plain(" Non intégrable. ")
    'non integrable'
    """
    bare = _MARKS.sub("", unicodedata.normalize("NFD", text.strip().lower().replace("’", "'")))
    return " ".join(bare.rstrip(".!").split())


#: Whole numbers in words.
NUMBERS: dict[str, int] = {plain(word): n for n, forms in enumerate(listed("numbers")) for word in forms.split()}
#: Nouns that say what is counted: a number of constraints is no number of degrees of freedom, and the other way round.
CONSTRAINT_NOUNS = word_list("constraint_nouns")
FREEDOM_NOUNS = word_list("freedom_nouns")
#: What is counted.
UNITS = word_list("units") | CONSTRAINT_NOUNS | FREEDOM_NOUNS
#: What leads to a number.
LEADING = word_list("leading")
#: After these comes a reason, which is read over.
REASONS = pattern("prose: reasons")
#: Words that turn a statement round or leave it open.
NEGATIONS = words("not no nicht kein keine pas nao não non never isn't")
#: Words that take back what is said, or leave it open.
DOUBTS = word_list("doubts")
#: Words of a remark that take back what it follows, where there are few; and what does in any.
_TAKING_BACK = word_list("taking_back")
_DOUBTFUL_WORDS = 3
_UNSURE = pattern("prose: unsure")
#: What draws a conclusion.
CONCLUSION = pattern("prose: conclusion")
#: What is answered to a word such as `holonomic:`.
YES = words("yes true ja wahr oui vrai si sim vero verdadero verdadera verdadeiro")
NO = words("no false not nein falsch nicht non faux falso falsa nao")
#: Alone they are no answer at all.
NOTHING_SAID = word_list("nothing_said")
#: Words between words of an answer that say nothing.
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
    """Return whether there is no answer: nothing, a dash, a question mark."""
    return isinstance(answer, str) and answer.strip().lower() in NOTHING_SAID
