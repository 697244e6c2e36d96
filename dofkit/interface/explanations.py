"""The entries of `dofkit explain`: feedback codes, fields, verdicts, arguments, theorems, sections, types and terms."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterator
from functools import cache
from importlib import resources
from typing import NamedTuple

from pydantic import BaseModel

from dofkit.base.documents import package_table
from dofkit.base.errors import Fault, SceneError
from dofkit.base.wording import closest, nearest, sentence, series
from dofkit.classification.arguments import arguments
from dofkit.homework.sentences import meanings
from dofkit.interface.show.assurance import assurance
from dofkit.report import ConstraintEntry, Report
from dofkit.scene.constraints import TYPES, ConstraintBase
from dofkit.scene.hints import section_lines
from dofkit.scene.picture import ShapeKeys, shape_kinds
from dofkit.scene.scene import Scene
from dofkit.scene.synonyms import synonyms

_THEOREM = re.compile(r"^\| `(?P<key>\w+)` \| (?P<author>[^|]+) \| (?P<year>[^|]+) \| (?P<says>[^|]+) \|", re.MULTILINE)
_WIDTH = 88


class Explanation(NamedTuple):
    """A word, its kind, and its meaning."""

    word: str
    kind: str
    meaning: str

    def text(self) -> str:
        """Return the explanation as lines for a terminal."""
        wrapped = textwrap.wrap(self.meaning, _WIDTH - 2, break_long_words=False, break_on_hyphens=False)
        return "\n".join([f"{self.word}: {self.kind}", *(f"  {line}" for line in wrapped)])


def explanations_of(word: str) -> list[Explanation]:
    """Return all meanings of a word, in any case. Raises SceneError with the nearest words if there is none.

    >>> explanations_of("NH_HALF")[0].kind, [e.kind for e in explanations_of("holonomic")]
    ('feedback code', ['field of a report', 'field of a constraint'])
    """
    wanted = _plain(word)
    explanations = [explanation for explanation in all_explanations() if _plain(explanation.word) == wanted]
    if explanations:
        return explanations
    lower = {_plain(explanation.word): explanation.word for explanation in all_explanations()}
    near = nearest(wanted, lower) or closest(wanted, list(lower), 0.5)
    within = [name for key, name in lower.items() if len(wanted) > 2 and wanted in key][:6]
    meant = list(dict.fromkeys(([lower[near]] if near else []) + within))
    hint = f"did you mean {' or '.join(f'`{name}`' for name in meant)}?" if meant else "`dofkit explain dof` is one"
    raise SceneError((Fault(f"there is no explanation of '{word}'", hint=hint),), word)


def listed() -> str:
    """Return all words as lines for a terminal, under the name of each kind."""
    kinds: dict[str, dict[str, None]] = {}
    for explanation in all_explanations():
        kinds.setdefault(explanation.kind, {})[explanation.word] = None
    blocks = []
    for kind, words in kinds.items():
        lines = textwrap.wrap(", ".join(words), _WIDTH - 2, break_long_words=False, break_on_hyphens=False)
        blocks.append("\n".join([kind, *(f"  {line}" for line in lines)]))
    return "\n".join(blocks)


def _plain(word: str) -> str:
    return re.sub(r"[\s_-]+", " ", word).strip().casefold()


@cache
def all_explanations() -> tuple[Explanation, ...]:
    """Return the explanations of all words."""
    return (
        *(Explanation(code, "feedback code", meaning) for code, meaning in meanings().items()),
        *_fields("field of a report", Report),
        *_fields("field of a constraint", ConstraintEntry),
        *(Explanation(name, "verdict", sentence(meaning)) for name, meaning in assurance("verdicts").items()),
        *(Explanation(word, "term", meaning) for word, meaning in package_table(__package__, "terms.yaml").items()),
        *(_section(name, line) for name, line in section_lines().items()),
        *(_type(name, cls) for name, cls in TYPES.items()),
        *(_shape(name, row) for name, row in shape_kinds().items()),
        *(Explanation(word, "synonym", f"In a scene it means `{kind}`.") for word, kind in synonyms().items()),
        *_arguments(),
        *_theorems(),
    )


def _fields(kind: str, model: type[BaseModel]) -> Iterator[Explanation]:
    for name, field in model.model_fields.items():
        yield Explanation(name, kind, sentence(field.description or ""))


def _section(name: str, line: str) -> Explanation:
    about = f"{sentence(Scene.model_fields[name].description or '')} For example `{line}`."
    return Explanation(name, "section of a scene", about)


def _type(name: str, cls: type[ConstraintBase]) -> Explanation:
    about = " ".join((cls.__doc__ or "").split())
    fields = [f"{key} ({field.description})" for key, field in cls.model_fields.items() if key not in ("type", "name")]
    spaces = series([str(d) for d in cls.dimensions])
    about = f"{about} Defined in {spaces} dimensions. Fields: {'; '.join(fields)}."
    return Explanation(name, "constraint type", f"{about} `dofkit catalog '{name}'` finds scenes.")


def _shape(name: str, row: ShapeKeys) -> Explanation:
    keys = ", ".join([*row.needs, *(f"{key} (optional)" for key in row.may)])
    text = f"{sentence(row.meaning)} Keys: {keys}. For example `{row.example}`."
    return Explanation(name, "shape of a picture", text)


def _arguments() -> Iterator[Explanation]:
    for key, row in arguments().items():
        theorem = f" Theorem: {row.theorem}." if row.theorem else ""
        yield Explanation(key, "argument", f"Claim: {row.claims}. Hypotheses: {row.hypotheses}.{theorem}")


def _theorems() -> Iterator[Explanation]:
    text = (resources.files("dofkit") / "THEOREMS.md").read_text(encoding="utf-8")
    for match in _THEOREM.finditer(text):
        says = f"{match['author'].strip()} {match['year'].strip()}: {match['says'].strip()}"
        yield Explanation(match["key"], "theorem", says)
