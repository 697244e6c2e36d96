"""The glossary (terms, fields, verdicts, arguments, feedback codes) and the theorems, from the package's own tables."""

from __future__ import annotations

import re
from collections.abc import Iterator
from importlib import resources

from pydantic import BaseModel

from dofkit.classification.arguments import TABLE
from dofkit.homework.key.misconceptions import CODES
from dofkit.interface.explanations import all_explanations
from dofkit.interface.show.assurance import VERDICT_MEANS
from dofkit.report import ConstraintEntry, Report
from dofkit.site.markdown import SitePage, anchor, code, prose, table

THEOREMS, GLOSSARY = "about/theorems.md", "reference/glossary.md"
#: Where the written part of the glossary has the tables of the package.
TABLES_HERE = "<!-- the tables of the package -->"
#: The lines of its tables: the two above, and one a theorem.
_HEAD = re.compile(r"^\| key .*\n\|[-| ]+\|\n", re.MULTILINE)
_ROW = re.compile(r"^\| `(\w+)` \|([^|]+)\|([^|]+)\|(.+)\|([^|]+)\|$", re.MULTILINE)


def report_pages(written: str) -> Iterator[SitePage]:
    """Return the glossary, which completes its ``written`` part by the package's own tables, and the theorems."""
    before, after = written.split(TABLES_HERE)
    yield SitePage(GLOSSARY, before + "\n\n".join(_tables()) + after)
    yield SitePage(THEOREMS, theorems((resources.files("dofkit") / "THEOREMS.md").read_text(encoding="utf-8")))


def _tables() -> Iterator[str]:
    yield "## Terms"
    words = sorted(((w.word, w.meaning) for w in all_explanations() if w.kind == "term"), key=lambda row: row[0])
    yield table(("term", "meaning"), [(prose(word), prose(meaning)) for word, meaning in words])
    yield "## Fields of a report"
    yield "`report.NAME` in Python, the keys of `dofkit classify --json`, and what `dofkit explain NAME` prints."
    yield _fields(Report)
    yield "## Fields of a constraint"
    yield "Each entry of `constraints` in a report has these fields."
    yield _fields(ConstraintEntry)
    yield "## Verdicts"
    yield "From the most to the least certain; the verdict of a report is the weakest in it."
    yield table(("verdict", "meaning"), [(code(name), prose(meaning)) for name, meaning in VERDICT_MEANS.items()])
    yield "## Arguments"
    yield "Every answer that is not undecided names the argument that it rests on (`verdicts.FIELD.argument`)."
    yield _arguments()
    yield "## Feedback codes"
    yield "Every mistake in homework that dofkit recognizes has a code, so that it can be counted over a class."
    yield table(("code", "meaning"), [(code(name), prose(meaning)) for name, meaning in CODES.items()])


def _fields(model: type[BaseModel]) -> str:
    rows = [(code(name), prose(field.description or "")) for name, field in model.model_fields.items()]
    return table(("field", "meaning"), rows)


def _arguments() -> str:
    rows = []
    for key, row in TABLE.items():
        theorem = f"[{row.theorem}](../{THEOREMS}#{anchor(row.theorem)})" if row.theorem else ""
        rows.append((prose(key), prose(row.claims), prose(row.hypotheses), theorem))
    return table(("argument", "what it shows", "hypotheses", "theorem"), rows)


def theorems(text: str) -> str:
    """`THEOREMS.md` with its tables as entries, each at a place that others can lead to.

    >>> print(theorems("| `Dini1878` | Dini | 1878 | A graph. | `a.py` |"))
    ### Dini1878 {#dini1878}
    <BLANKLINE>
    **Dini, 1878.** A graph.
    <BLANKLINE>
    <small>Used in `a.py`</small>
    <BLANKLINE>
    """
    return _ROW.sub(_theorem, _HEAD.sub("", text))


def _theorem(row: re.Match[str]) -> str:
    key, author, year, says, where = (cell.strip() for cell in row.groups())
    return f"### {key} {{#{anchor(key)}}}\n\n**{author}, {year}.** {prose(says)}\n\n<small>Used in {where}</small>\n"
