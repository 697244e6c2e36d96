"""Word lists for texts of answers, in English, German, French, Spanish, Italian and Portuguese."""

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
    """Return the set of the words of a text."""
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
    """Return a text in lower case, without accents, blanks around it and the full stop at its end.

    >>> plain(" Non intégrable. ")
    'non integrable'
    """
    bare = _MARKS.sub("", unicodedata.normalize("NFD", text.strip().lower().replace("’", "'")))
    return " ".join(bare.rstrip(".!").split())


#: Whole numbers in words; masculine, feminine and counted forms.
NUMBERS: dict[str, int] = {plain(word): n for n, forms in enumerate(listed("numbers")) for word in forms.split()}
#: Nouns of counted quantities: a number of constraints is not a number of degrees of freedom.
CONSTRAINT_NOUNS = word_list("constraint_nouns")
FREEDOM_NOUNS = word_list("freedom_nouns")
#: All nouns of counted quantities.
UNITS = word_list("units") | CONSTRAINT_NOUNS | FREEDOM_NOUNS
#: Words that lead to a number.
LEADING = word_list("leading")
#: Words before a reason, which is ignored.
REASONS = pattern("prose: reasons")
#: Words that negate a statement.
NEGATIONS = words("not no nicht kein keine pas nao não non never isn't")
#: Words that question an answer.
DOUBTS = word_list("doubts")
#: Words that question the answer in a remark of at most `_DOUBTFUL_WORDS` words; phrases that do so in any remark.
_TAKING_BACK = word_list("taking_back")
_DOUBTFUL_WORDS = 3
_UNSURE = pattern("prose: unsure")
#: Words before a conclusion.
CONCLUSION = pattern("prose: conclusion")
#: Replies after a word such as `holonomic:`.
YES = words("yes true ja wahr oui vrai si sim vero verdadero verdadera verdadeiro ✓ ✔ ✅")
NO = words("no false not nein falsch nicht non faux falso falsa nao ✗ ✘ ❌")
#: Texts that are no answer.
NOTHING_SAID = word_list("nothing_said")
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
