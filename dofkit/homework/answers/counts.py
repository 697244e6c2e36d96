"""Reads a number as people write it: digits or words, with a unit, a calculation before it, a reason after it."""

from __future__ import annotations

import re
from collections.abc import Iterator
from fractions import Fraction

from dofkit.base.errors import TextError
from dofkit.expressions.text import Names, parse_relations
from dofkit.homework.answers.notation import Script, script_of
from dofkit.homework.answers.prose import (
    CONCLUSION,
    DOUBTS,
    LEADING,
    NEGATIONS,
    NUMBERS,
    REASONS,
    UNITS,
    pattern,
    plain,
    takes_back,
    words,
)
from dofkit.homework.answers.words import one_text
from dofkit.homework.judgement import DoubtError

_HINT = "write a number such as 3"
_COMMA = re.compile(r"(?<=\d),(?=\d)")
_GROUP = re.compile(r"\s*\(([^()]*)\)")
#: A factor in parentheses within a calculation, `3(4 - 1) - 2 4`; at the end it may repeat the number before it.
_FACTOR = re.compile(r"\d\([^()]*\d[^()]*\)\s*[-+*/=−·⋅×]")
_SEGMENT = pattern("counts: segment")
#: A number that is corrected by the next one, and dropped: `not 3 but 2`.
_REPLACED = pattern("counts: replaced")
#: A parenthesis with another number under a condition: `(4 with the winch)`.
_CONDITION = pattern("counts: condition")
#: Brackets of a set, and a number in bold letters of Markdown.
_BRACKETS, _BOLD = re.compile(r"[{}\[\]]"), re.compile(r"\A\s*\*\*([^*]+)\*\*(?=\s*\Z)")
#: Signs and words of a bound on the number; words for an alternative; a number with a name before a sign of equality.
_BOUND = pattern("counts: bound")
_OTHERWISE = pattern("counts: otherwise")
_BEFORE_NAME = re.compile(r"\s*\d+(?:\s+[^\W\d_]+){1,2}\s*")
#: In a segment of more words, `one` may be an article.
_ARTICLE_WORDS = 2
#: A denial of at least so many words without a number is a remark on something else.
_REMARK_WORDS = 4
_ALONE = re.compile(r"(?<![\w^*/+.-])(?:\d{1,4}|[^\W\d_]+)(?![\w^*/+.])")
#: Names of other quantities.
_OTHERS = words("n k f dof x y z t theta phi")
_NAMED = re.compile(r"\s*([^\W\d_]+)\s*(?:=|[<>≤≥≠∈]|!=|\\(?:leq?|geq?|neq?|lt|gt|in)\b)")
_SIGNS = re.compile(r"==|=|≈|≅|→|⇒")
#: A side of an equation between coordinates, which is not a number: `x^2 + y^2`, `z_C`.
_FORMULA = re.compile(r"[^\W\d]\w*\s*(?:\^|\*\*|[²³])|\b(?:sin|cos|tan)\b|(?:\A|=)\s*[xyz]_?\w{0,2}\s*=")
_WORD = pattern("counts: word")
_OPERATORS = {"minus": "-", "less": "-", "moins": "-", "menos": "-", "meno": "-", "plus": "+", "mas": "+", "piu": "+",
              "times": "*", "mal": "*"}  # fmt: skip
#: Words up to a verb before the number: `das Doppelpendel hat`.
_STATED = pattern("counts: stated")
_FIGURE = re.compile(r"[\d½⅓⅔¼¾]")
_BETWEEN = re.compile(r"\s*\d+\s*[-–]\s*\d+\s*")
_ENDING = re.compile(r"[\s.!]+$")
_NONE = words("none no kein keine keinen aucun ninguno ninguna nessuno nenhum")


def number(answer: object, called: frozenset[str] = frozenset(), foreign: frozenset[str] = frozenset()) -> Fraction:
    """Return the one number that an answer claims: ``4``, ``f = 6 - 2 = 4``, ``zwei``, ``two (2)``, ``2 ddl``, ``0,5``.

    ``called``: names of the quantity; a number with such a name counts before all others. ``foreign``: nouns of other
    quantities, whose numbers are not the one asked for. Raises TextError, with its column; DoubtError for several.
    """
    if isinstance(answer, (list, tuple)) and len(answer) == 1:
        return number(answer[0], called, foreign)
    script = script_of(one_text(answer)).replaced(_BOLD, r"\1").replaced(_COMMA, ".")
    if not re.search(r"[\\^_]", script.text):
        script = script.replaced(_BRACKETS, " ")
    reason = REASONS.search(script.text)
    body = script if reason is None else script.cut(0, reason.start())
    body = _concluded(body.replaced(_REPLACED, ""))
    amounts, first, unread = set[Fraction](), None, set[int]()
    segments = list(_segments(body))
    named = [part for part in segments if (name := _NAMED.match(part.text)) and plain(name[1]) in called]
    strange = [part for part in segments if (name := _NAMED.match(part.text)) and plain(name[1]) in _OTHERS - called]
    others = [part for part in segments if part not in named and _only_number(part.text)]
    for segment in [*named, *others] if named else segments:
        try:
            amount = _segment(segment, _OTHERS - called)
        except DoubtError:
            raise
        except TextError as error:
            first = first or segment.moved(error)
            unread |= _numbers_alone(segment.text)
            continue
        if amount is None:
            continue
        different = segment in strange or _is_foreign(segment.text, foreign) or _FORMULA.search(segment.text)
        if different and segment not in named:
            raise DoubtError("it is labelled as a different quantity.", segment.columns[0], _HINT)
        amounts.add(amount)
    if not amounts:
        raise first or TextError("there is no number in this answer", 1, _HINT)
    if len(amounts) > 1 or (not named and not amounts >= unread):
        raise DoubtError("it gives more than one number.", 1, _HINT)
    return amounts.pop()


def _concluded(script: Script) -> Script:
    """Return the script after the conclusion word such as `therefore`, if a number follows; else the whole script."""
    ends = [match.end() for match in CONCLUSION.finditer(script.text)]
    conclusion = script.cut(ends[-1]) if ends else script
    return conclusion if ends and (_FIGURE.search(conclusion.text) or plain(conclusion.text) in NUMBERS) else script


def _is_foreign(text: str, foreign: frozenset[str]) -> bool:
    """Return whether the number of a segment is followed by the noun of another quantity."""
    after = re.split(r"\d+", text)[-1] if re.search(r"\d", text) else text
    said = [plain(m[0]) for m in _WORD.finditer(after)]
    return not foreign.isdisjoint(said) and "=" not in text


def _numbers_alone(text: str) -> set[int]:
    """Return the numbers that stand alone in an unreadable segment; in more than two words `one` is an article."""
    alone = [plain(w) for w in _ALONE.findall(text)]
    least = 1 if len(alone) > _ARTICLE_WORDS else 0
    return {int(w) if w.isdecimal() else NUMBERS[w] for w in alone if w.isdecimal() or NUMBERS.get(w, 0) > least}


def _segments(script: Script) -> Iterator[Script]:
    """Yield the parts between separators, and numbers in parentheses after a number; other parentheses are remarks."""
    for group in _GROUP.finditer(script.text):
        before = script.text[: group.start()].rstrip()
        if before and before[-1] not in "+-*/=(^−·⋅×" and not _FACTOR.match(script.text, len(before) - 1):
            inside = script.cut(*group.span(1))
            if takes_back(inside.text):
                raise DoubtError("a remark makes the answer ambiguous.", inside.columns[0], _HINT)
            if _CONDITION.match(inside.text) or (_OTHERWISE.search(inside.text) and _FIGURE.search(inside.text)):
                raise DoubtError("it gives more than one number.", inside.columns[0], _HINT)
            if _only_number(inside.text) and any(_only_number(w) for w in re.findall(r"[^\W_]+", before)):
                yield inside
            script = script.replaced(re.compile(re.escape(group[0])), " " * len(group[0]))
    place = 0
    for cut in [*(m.span() for m in _SEGMENT.finditer(script.text)), (len(script.text), len(script.text))]:
        part = script.cut(place, cut[0])
        if part.text.strip():
            yield part
        place = cut[1]


def _only_number(text: str) -> bool:
    return plain(text) in NUMBERS or re.fullmatch(r"[\d\s.+*/-]*\d[\d\s.+*/-]*", text) is not None


def _segment(script: Script, others: frozenset[str]) -> Fraction | None:
    """Return the number of a segment, or None if it contains none. Raises DoubtError if its two sides differ.

    ``others``: names of other quantities; `3n - k with n = 2` gives the number of one, and not the one asked for.
    """
    place, amounts, failure = 0, list[Fraction](), None
    text = script.text
    bound = _BOUND.search(text)
    if bound is not None:
        raise DoubtError("it gives a bound, not the number.", script.columns[bound.start()], _HINT)
    for cut in [*(m.span() for m in _SIGNS.finditer(text)), (len(text), len(text))]:
        side = script.cut(place, cut[0])
        place = cut[1]
        before, named = ["", "", *map(plain, side.text.split())][-2:]
        if cut[1] > cut[0] and before.isalpha() and before not in _OPERATORS and named in others:
            raise DoubtError("it is labelled as a different quantity.", side.columns[0], _HINT)
        try:
            value = _value(side)
        except TextError as error:
            failure = error
            if place >= len(text):
                raise
            if _BEFORE_NAME.fullmatch(side.text):
                raise DoubtError("it gives more than one number.", side.columns[0], _HINT) from None
            continue
        if value is not None:
            amounts.append(value)
            failure = None
        elif cut[0] >= len(text):
            failure = failure or TextError("there is no number here", 1, _HINT)
    if len(set(amounts)) > 1:
        raise DoubtError("its numbers contradict each other.", script.columns[0], _HINT)
    if failure is not None and not amounts:
        raise failure
    if amounts and amounts[-1] < 0 and _BETWEEN.fullmatch(script.text):
        raise DoubtError("it gives more than one number.", script.columns[0], _HINT)
    return amounts[-1] if amounts else None


def _value(script: Script) -> Fraction | None:
    """Return the number of a text without signs of equality, or None if there are only words."""
    words = [plain(m[0]) for m in _WORD.finditer(script.text)]
    if (
        any(w in _NONE for w in words)
        and not re.search(r"\d", script.text)
        and all(w in _NONE or w in UNITS or w in LEADING for w in words)
    ):
        return Fraction(0)
    counted = _FIGURE.search(script.text) is not None or any(w in NUMBERS for w in words)
    negated = any(w in NEGATIONS for w in words) and (counted or len(words) < _REMARK_WORDS)
    if negated or any(w in DOUBTS for w in words):
        raise DoubtError("it is not clear which number is claimed.", script.columns[0], _HINT)
    if script.text.rstrip().endswith("?"):
        raise DoubtError("a question mark makes the answer ambiguous.", script.columns[0], _HINT)
    stated = _STATED.match(script.text)
    if stated is not None and not any(NUMBERS.get(w, 0) > 1 for w in map(plain, _WORD.findall(stated[0]))):
        script = script.cut(stated.end())
    figures = _FIGURE.search(script.text)
    start = len(script.text) if figures is None else figures.start()
    remainder = script.replaced(_WORD, lambda m: _counted(m, m.start() < start)).replaced(_ENDING, "")
    if not remainder.text.strip():
        return None
    if re.search(r"[^\W\d_]", remainder.text) and not _FIGURE.search(remainder.text):
        return None
    return _arithmetic(remainder)


def _counted(match: re.Match[str], leads: bool) -> str:
    """Return the text for a word: digits for a number, a sign for an operator, "" for a unit, else the word itself."""
    word = plain(match[0]).replace(". ", "").replace(".", "")
    if word in _OPERATORS:
        return _OPERATORS[word]
    article = word in ("un", "une", "una", "um", "uma", "a") and re.match(r"\s*\d", match.string[match.end() :])
    if word in NUMBERS and not article:
        return str(NUMBERS[word])
    return "" if word in UNITS or (leads and word in LEADING) else match[0]


def _arithmetic(script: Script) -> Fraction:
    try:
        relations = parse_relations(script.text, Names(allow_time=False, allow_velocities=False))
    except TextError as error:
        raise script.moved(TextError(error.message, error.column, _HINT)) from None
    value = relations[0].left
    if len(relations) > 1 or value.op != "num" or not isinstance(value.args[0], Fraction):
        raise TextError("this is not a number", script.columns[0], _HINT)
    return value.args[0]
