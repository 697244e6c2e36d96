"""What reports say: every field, verdict, argument and code of feedback, told by the package's own tables."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from importlib import resources

from dofkit.classification.arguments import TABLE
from dofkit.homework.key.codes import CODES
from dofkit.interface.explanations import all_explanations
from dofkit.interface.field_meanings import OF_CONSTRAINT, OF_REPORT
from dofkit.interface.show.assurance import VERDICT_MEANS
from dofkit.site.markdown import SitePage, anchor, code, page, prose, table

THEOREMS = "about/theorems.md"
#: The lines of its tables: the two above, and one a theorem.
_HEAD = re.compile(r"^\| key .*\n\|[-| ]+\|\n", re.MULTILINE)
_ROW = re.compile(r"^\| `(\w+)` \|([^|]+)\|([^|]+)\|(.+)\|([^|]+)\|$", re.MULTILINE)


def report_pages() -> Iterator[SitePage]:
    """The reference of reports, words, arguments and codes, and the theorems."""
    yield SitePage("reference/report.md", _report())
    yield SitePage("reference/arguments.md", _arguments())
    yield SitePage("reference/words.md", _words())
    yield SitePage("reference/feedback.md", _feedback())
    yield SitePage(THEOREMS, theorems((resources.files("dofkit") / "THEOREMS.md").read_text(encoding="utf-8")))


def _report() -> str:
    return page(
        "Report fields and verdicts",
        "`report.NAME` in Python, the keys of `dofkit classify --json`, and what `dofkit explain NAME` says. "
        "[What the answers mean](../guide/answers.md) tells how they hang together.",
        "## Of a report",
        _fields(OF_REPORT),
        "## Of a constraint",
        "Each entry of `constraints`:",
        _fields(OF_CONSTRAINT),
        "## Verdicts",
        "From the surest to the least sure; that of a report is the weakest in it.",
        table(("verdict", "how sure"), [(code(name), prose(told)) for name, told in VERDICT_MEANS.items()]),
        "`about` tells of which points a claim speaks: the part of the configurations near the `reference`, the "
        "`component` that holds the `witness`, or `everywhere`.",
    )


def _fields(meanings: Mapping[str, str]) -> str:
    rows = [(code(name), prose(told)) for name, told in meanings.items()]
    return table(("field", "meaning"), rows)


def _arguments() -> str:
    rows = []
    for key, row in TABLE.items():
        theorem = f"[{row.theorem}](../{THEOREMS}#{anchor(row.theorem)})" if row.theorem else ""
        rows.append((prose(key), prose(row.claims), prose(row.hypotheses), theorem))
    return page(
        "Arguments",
        "Every sure answer names the argument by which it was found (`verdicts.FIELD.argument`): what it shows, from "
        "which hypotheses, which are checked each time, and the theorem behind it.",
        table(("argument", "it shows", "it holds because", "theorem"), rows),
    )


def _words() -> str:
    words = [told for told in all_explanations() if told.kind == "word"]
    return page("Words", table(("word", "meaning"), [(prose(w.word), prose(w.meaning)) for w in words]))


def _feedback() -> str:
    return page(
        "Codes of feedback",
        "What is wrong with an answer of homework has a stable code, so that it can be counted over a class.",
        table(("code", "what it says"), [(code(name), prose(told)) for name, told in CODES.items()]),
    )


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
