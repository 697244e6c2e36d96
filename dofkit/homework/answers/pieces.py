"""Splits an answer into equations, and drops remarks, titles and numbers of equations."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from dofkit.base.errors import TextError
from dofkit.expressions.text import Names, parse_relations, spelled
from dofkit.expressions.text.characters import GREEK
from dofkit.expressions.text.tokens import read_word
from dofkit.homework.answers.notation import ARROW, Script, script_of, with_differentials
from dofkit.homework.answers.prose import CONCLUSION, pattern, plain, takes_back, word_list
from dofkit.homework.answers.words import one_text
from dofkit.homework.judgement import DoubtError, Given

#: The most equations in one answer.
MOST_PIECES = 40
#: The number after an equation: ``(3)``.
_NUMBER_AFTER = re.compile(r"(?<=[^\s=+\-−*·×/^<>≤≥])\s+\((?:\d{1,2}|[IVX]{1,4}|\*)\)\s*\Z")
_RELATION = re.compile(r"[=<>≤≥]")
_ENUMERATED = pattern("pieces: enumerated")
_AND = pattern("pieces: and")
#: The letter y or e, which is the Spanish or Italian word for "and", between what may be two equations.
_CONJUNCTION = re.compile(r"(?<=[^\s=<>≤≥+\-*/^(,])\s+[ye]\s+(?=[^\s=<>≤≥+\-*/^),])")
_DECIMAL = re.compile(r"(?<=\d),(?=\d)")
_WORDS = re.compile(r"[^\W\d]+(?:['’][^\W\d]+)*")
_GROUP = re.compile(r"[(\[]([^()\[\]=<>+*/^\d]+)[)\]]\s*\Z|[(\[]([^()\[\]=<>+*/^\d]+)[)\]](?=\s*[;,\n])")
_INTRODUCED = pattern("pieces: introduced")
#: Words after an equation such as `for all t`.
_ALWAYS = pattern("pieces: always")
#: The name of a family of curves before its equation.
_CURVES = pattern("pieces: curves")
_TITLED = re.compile(r"\A\s*[^=<>:+*/^]{1,60}:(?!=)\s*(?=\S)")
_REMARKED = word_list("pieces: remarked")
_ABOUT_CONSTANT = pattern("pieces: about a constant")
#: A sign of approximate equality for rounded numbers.
_ROUNDED = re.compile(r"(?:[≈≃≅]|\\(?:approx|simeq|cong)(?![A-Za-z]))(?=.*\d[.,]\d)")
_CHAINED = re.compile(r"(?<![<>=!])=(?!=)")
#: A statement after an equation that a side is constant: `x + y = l = const.`
_CONSTANT_SIDE = re.compile(r"(?<==)([^=<>]+)=\s*(?:const|konst|cte|cst)[^\W\d_]*\.?\s*\Z", re.IGNORECASE)
#: Energies that lead to a Lagrangian: `T = ..., V = ..., L = T - V` is one expression.
_ENERGY = r"(?:E_?\{?(?:kin|pot|k|p)\w{0,6}\}?|[TVUK](?:_\{?\w{1,4}\}?)?)"
_STEP = re.compile(rf"\A\s*(?P<name>{_ENERGY})\s*=(?!=)(?P<value>[^=<>]+)\Z")
_RESULT = pattern("pieces: result")
_NAME = re.compile(rf"(?<![\w\\]){_ENERGY}(?!\w)")
_FUNCTION = pattern("pieces: function")
_CALLED = re.compile(r"\A\s*\\?([A-Za-zα-ωΑ-Ω]\w*)\s*\(\s*\\?(?:var)?([A-Za-zα-ωΑ-Ω]\w*)\s*\)\s*=(?!=)")
_POWER_OF_E = re.compile(r"(?<![\w\\])([A-Za-zα-ωΑ-Ω])e(?=\s*(?:\^|\*\*))")
_CONSTANTS = re.compile(r"\b(const|konst|cst|cte)(?:[^\W\d_]*)\.?(?!\w)", re.IGNORECASE)


@dataclass(frozen=True)
class Pieces:
    """The equations of an answer; ``derived``: whether arrows lead from each equation to the next."""

    scripts: tuple[Script, ...]
    derived: bool = False


def pieces_of(answer: object, names: Names) -> Pieces:
    """Return the equations of an answer, a text or a list. Raises TextError if there are none or too many."""
    texts = [one_text(part) for part in answer] if isinstance(answer, (list, tuple)) else [one_text(answer)]
    equations: list[Script] = []
    derived = False
    for text in texts:
        script = script_of(text).replaced(CONCLUSION, ARROW)
        if "d" not in names.coordinates and "d" not in names.parameters:
            script = with_differentials(script)
        derived = derived or ARROW in script.text
        equations += [p for part in _split(script, names) if (p := _cleaned(part, names)) is not None]
    if not equations:
        raise TextError("there is no formula in this answer", 1, "write a formula such as x^2 + y^2 = l^2")
    if len(equations) > MOST_PIECES:
        raise TextError(f"there are {len(equations)} equations", equations[MOST_PIECES].columns[0], "give fewer")
    return Pieces(tuple(equations), derived and len(equations) > 1)


def _split(script: Script, names: Names) -> Iterator[Script]:
    """Yield the parts between line ends, signs and words that separate equations."""
    lines = _joined(script)
    for line in lines:
        cuts = sorted({*_at_signs(line.text), *_at_words(line.text, names)})
        place = 0
        for start, end in [*cuts, (len(line.text), len(line.text))]:
            if start >= place:
                yield line.cut(place, start)
                place = end


def _joined(script: Script) -> list[Script]:
    """Return the lines of a script; a line is joined to the previous one if an operator begins it or ends that one."""
    text, cuts = script.text, []
    for match in re.finditer(r"[\r\n]+", text):
        before, after = text[: match.start()].rstrip(), text[match.end() :].lstrip()
        line = after.splitlines()[0] if after else ""
        bulleted = (
            after[:1] in ("-", "+", "*", "•")
            and _RELATION.search(line)
            and _RELATION.search(before.splitlines()[-1] if before else "")
        )
        goes_on = (after[:1] in tuple("+-*/=<>)^") and not bulleted) or before[-1:] in tuple("+-*/=(<>^,")
        if not goes_on or before[-1:] == ",":
            cuts.append(match.span())
    joined, place = [], 0
    for start, end in [*cuts, (len(text), len(text))]:
        joined.append(script.cut(place, start).replaced(re.compile(r"[\r\n]"), " "))
        place = end
    bullet = re.compile(r"\A\s*[-*•]\s+")
    if len(joined) > 1 and all(bullet.match(script_line.text) for script_line in joined if script_line.text.strip()):
        joined = [script_line.replaced(bullet, "") for script_line in joined]
    return joined


def _at_signs(text: str) -> Iterator[tuple[int, int]]:
    """Yield the spans of semicolons, arrows, list numbers, and commas outside of brackets that are no decimal signs."""
    depth = 0
    for i, char in enumerate(text):
        depth += (char in "([{") - (char in ")]}")
        if char in ";" + ARROW or (char == "," and depth <= 0 and not _DECIMAL.match(text, i)):
            yield i, i + 1
    yield from (m.span() for m in _ENUMERATED.finditer(text) if not _within_brackets(text[: m.start()]))


def _within_brackets(before: str) -> bool:
    """Return whether a parenthesis is open at the end of a text; an unmatched closing one is ignored."""
    depth = 0
    for char in before:
        depth = max(0, depth + (char == "(") - (char == ")"))
    return depth > 0


def _at_words(text: str, names: Names) -> Iterator[tuple[int, int]]:
    """Yield the spans of words between two equations, such as `and`."""
    for match in _AND.finditer(text):
        yield match.span()
    for match in _CONJUNCTION.finditer(text):
        between = all(map(_RELATION.search, (text[: match.start()], text[match.end() :])))
        if between and match[0].strip() not in {*names.coordinates, *names.parameters, "e"}:
            yield match.span()


def _cleaned(script: Script, names: Names) -> Script | None:
    """Return an equation without remarks, titles and numbers, or None if the script is only a remark."""
    script = script.stripped()
    while (group := _GROUP.search(script.text)) is not None and _is_remark(group[1] or group[2] or "", names, 3):
        _check(group[0], script.columns[group.start()])
        script = script.replaced(re.compile(re.escape(group[0])), " ").stripped()
    script = script.replaced(re.compile(r"\A\s*(?:\.|&)+|\s*\.\s*\Z|!\s*\Z"), "").stripped()
    if _RELATION.search(script.text):
        script = script.replaced(_NUMBER_AFTER, "").replaced(_ALWAYS, "").stripped()
    script = script.replaced(_CONSTANT_SIDE, r"\1")
    script = script.replaced(_CURVES, "") if _RELATION.search(script.text) else script
    for lead in (_TITLED, _INTRODUCED):
        match = lead.match(script.text)
        if match is not None and _is_lead(match[0], names):
            script = script.cut(match.end()).stripped()
    text = script.text
    if not text or (_ABOUT_CONSTANT.fullmatch(text) and not _of_coordinates(text, names)) or _is_remark(text, names):
        _check(text, script.columns[0])
        return None
    if len(_CHAINED.findall(text)) > 1 and _CONJUNCTION.search(text):
        raise DoubtError("a letter may be a factor or the word for `and`.", script.columns[0], "write `;`")
    script = script.replaced(_ROUNDED, "=").replaced(_DECIMAL, ".")
    if script.text != text and len(_CHAINED.findall(text)) > 1:
        raise DoubtError("a comma may be a decimal sign or a separator between equations.", script.columns[0], None)
    return script


def _check(remark: str, column: int) -> None:
    """Raise DoubtError for a remark that questions the answer."""
    if takes_back(remark):
        raise DoubtError("a remark makes the answer ambiguous.", column, None)


def _is_declared(word: str, names: Names) -> bool:
    return names.lookup.meaning(word) is not None


def _readable(word: str, names: Names) -> bool:
    """Return whether a word is a name, or a product of names, such as `mgl`."""
    try:
        return bool(read_word(word, names.lookup, 1, False))
    except TextError:
        return False


def _is_lead(text: str, names: Names) -> bool:
    """Return whether a text before an equation is a title: words without declared names, or a name with a colon."""
    lead_words = re.findall(r"\w+", text)
    least = 0 if ":" in text else 1
    is_title = len(lead_words) > 1 or ":" in text
    return is_title and not any(len(w) > least and _is_declared(w, names) for w in lead_words)


def _of_coordinates(text: str, names: Names) -> bool:
    """Return whether the left side contains coordinates, as in `x y = const`; if it is unreadable, the whole text."""
    try:
        relations = parse_relations(re.split(r"[=∈:]", text)[0], names)
    except TextError:
        return any(w in names.coordinates for w in re.findall(r"\w+", text))
    return any(s.args[0] != "parameter" for c in relations for s in c.left.symbols)


def _is_remark(text: str, names: Names, least: int = 5) -> bool:
    """Return whether a text is a remark: several unknown words, a long one or a listed one, and no declared name."""
    if re.search(r"[=<>≤≥+*/^\\\d±|·⋅×−√½⅓¼¾²³¹⁰-₉]", text):
        return False
    if all(_readable(w, names) for w in _WORDS.findall(text)):
        return False
    remark_words = [plain(w) for w in _WORDS.findall(text)]
    unknown = [w for w in remark_words if not _is_declared(w, names)]
    if not unknown or any(len(w) > 1 and _is_declared(w, names) for w in remark_words):
        return False
    long = [w for w in unknown if len(w) > 3]
    if any(w in _REMARKED for w in unknown) or len(unknown) > 2 or (len(unknown) > 1 and bool(long)):
        return True
    return len(unknown) == 1 and len(unknown[0]) >= least and unknown[0] not in GREEK.values()


def with_energies(answer: Given, names: Names) -> Given:
    """Return the last step ``L = T - V`` with the energies of earlier steps inserted; other answers unchanged."""
    try:
        *steps, last = [script.text for script in pieces_of(answer, names).scripts]
    except TextError:
        return answer
    definitions = [_STEP.match(step) for step in steps]
    result = _RESULT.match(last)
    if result is None or not definitions or None in definitions:
        return answer
    energies = {step["name"]: f"({step['value'].strip()})" for step in definitions if step is not None}
    if any(names.lookup.meaning(name) is not None for name in energies):
        return answer
    return _NAME.sub(lambda energy: energies.get(energy[0], energy[0]), result["value"])


def plainer(script: Script, names: Names) -> Script:
    """Return the script without a leading function name; `r(phi) =` becomes `r =`, and `Ce^x` becomes `C e^x`."""
    script = _without_function(script, names)
    match = _CALLED.match(script.text)
    if match is not None and {spelled(match[1]), spelled(match[2])} <= names.coordinates:
        script = script.replaced(_CALLED, lambda m: f"{m[1]} =")
    if names.lookup.meaning("e") is not None:
        return script
    return script.replaced(_POWER_OF_E, lambda m: m[0] if names.lookup.meaning(m[0]) is not None else f"{m[1]} e")


def _without_function(script: Script, names: Names) -> Script:
    """Return the script without a leading `f(x, y) =`; words such as `const.` become the name `const`."""
    script = script.replaced(_CONSTANTS, "const")
    lead = _FUNCTION.match(script.text)
    if lead is None or not re.search(r"[^\W\d]", script.text[lead.end() :]):
        return script
    if "(" not in lead[0] and not re.match(r"\s*[fgh]", lead[0]) and "=" not in script.text[lead.end() :]:
        return script
    name = re.sub(r"[\\{}]", "", lead[0].split("=")[0].split("(")[0]).strip()
    listed = "," in lead[0]
    if listed and name in names.parameters:
        return script.cut(lead.end())
    if names.lookup.meaning(name) is not None or re.search(rf"\b{re.escape(name)}\b", script.text[lead.end() :]):
        return script
    return script.cut(lead.end())
