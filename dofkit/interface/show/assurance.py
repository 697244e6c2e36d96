"""How certain the answers of a report are, and by which arguments."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf, log10

from dofkit.base.documents import package_table
from dofkit.base.verdicts import ArgumentKey
from dofkit.base.wording import gap_in_words
from dofkit.interface.show.sheet import Remark
from dofkit.report import FieldVerdict, Report

#: Hypotheses shorter than this only refer to other arguments ("the others"), and are not printed.
_TERSE = 14
#: The most fields that are named in one line.
_MOST_FIELDS = 6
#: {where a claim is valid: its text}, for claims that are not about the whole configuration space.
_NEAR = {"component": ", near the witness", "reference": ", near the reference configuration"}
#: The separator in `Report.modelled` before each part of a model that the scene leaves out.
LEFT_OUT = "; left out: "


def assurance(what: str) -> dict[str, str]:
    """Return {key: text} for ``what``: verdicts, models, methods or fields (`assurance.yaml`)."""
    words: dict[str, str] = package_table(__package__, "assurance.yaml")[what]
    return words


def _field(name: str) -> str:
    return assurance("fields").get(name, name.replace("_", " "))


def _in_words(text: str, what: str) -> str:
    for words, meaning in assurance(what).items():
        text = text.replace(words, meaning)
    return text


def certainty(report: Report) -> list[Remark]:
    """Return the model, the method, the meaning of the verdicts and the argument behind each answer."""
    model, *lacks = _in_words(report.modelled, "models").split(LEFT_OUT)
    remarks = [Remark(label, text) for label, text in (("model", model), ("method", method_in_words(report))) if text]
    remarks += [Remark("not modelled", text) for text in lacks]
    used = {report.verdict, *(e.verdict for e in report.constraints), *(case.verdict for case in report.special_cases)}
    remarks += [Remark(verdict, meaning) for verdict, meaning in assurance("verdicts").items() if verdict in used]
    return [*remarks, *_arguments(report)]


def left_out(report: Report) -> str:
    """Return the parts of the model that the scene leaves out, in one line; empty if there are none."""
    return "; ".join(report.modelled.split(LEFT_OUT)[1:])


def reservation(report: Report) -> str:
    """Return why the report is not proved: the chance of an error, the gap, or what is undecided; empty if proved."""
    weakest = [(name, entry) for name, entry in report.verdicts.items() if entry.verdict == report.verdict]
    bounds = [entry.bound for _, entry in weakest if entry.bound]
    labels = [v for e in report.constraints for v in e.verdicts.values() if v.verdict == report.verdict]
    bounds += [label.bound for label in labels if label.bound]
    if report.verdict == "probable" and not bounds:
        return "no evidence for the checker (details: --how)"
    if report.verdict == "probable":
        digits = min(int(int(bound.removeprefix("2^-")) * log10(2)) for bound in bounds)
        return f"chance of error below 1e-{digits} (details: --how)"
    if report.verdict == "numeric" and bounds:
        return f"{_gap(min(bounds, key=float), report.method)} (details: --how)"
    if report.verdict == "undecided":
        names = [_field(name) for name, _ in weakest]
        names += [entry.name for entry in report.constraints if entry.verdict == "undecided"]
        listed = ", ".join(names[:_MOST_FIELDS]) + (", ..." if len(names) > _MOST_FIELDS else "")
        return f"{listed} (details: --how)" if listed else ""
    return ""


def _gap(bound: str, method: str) -> str:
    """Return the gap of a numeric answer, between values taken as zero and all others, in words."""
    if float(bound) == inf:
        return "no value is taken as zero"
    return gap_in_words(float(bound), "singular value" if "singular values" in method else "value")


def method_in_words(report: Report) -> str:
    """Return the method of a report in words."""
    if report.method == "count":
        return "counting: each equation is evidently independent of the others"
    return _in_words(report.method, "methods").replace("over GF(p)", "modulo a large prime")


def _arguments(report: Report) -> Iterator[Remark]:
    """Yield for each argument of the report: the fields that depend on it, its claim, hypotheses and theorem."""
    fields_of: dict[ArgumentKey, list[str]] = {}
    for name, entry in report.verdicts.items():
        if entry.argument is not None:
            fields_of.setdefault(entry.argument, []).append(_field(name))
    from dofkit.classification.arguments import arguments

    for key, names in fields_of.items():
        row = arguments()[key]
        theorem = f" [{row.theorem}]" if row.theorem else ""
        hypotheses = "" if len(row.hypotheses) < _TERSE else f" (condition: {row.hypotheses})"
        text = f"{row.claims}{hypotheses}".replace("over GF(p)", "modulo a large prime")
        yield Remark(", ".join(names), f"'{key}': {text}{theorem}")


def not_proved(report: Report) -> list[Remark]:
    """Return a remark for each reason why fields are not proved, with these fields."""
    fields_of: dict[str, list[str]] = {}
    for name, entry in report.verdicts.items():
        if entry.verdict != "proved":
            same = fields_of.setdefault(f"{entry.verdict}{_because(entry, report.method)}", [])
            same.append(assurance("fields").get(name, name))
    return [Remark(", ".join(names), said) for said, names in fields_of.items()]


def checked_claims(report: Report) -> list[Remark]:
    """Return how many proved claims the checker confirmed, and which it did not; empty without a certificate."""
    proved = {name: verdict.checked for name, verdict in report.verdicts.items() if verdict.verdict == "proved"}
    for entry in report.constraints:
        proved |= {f"{entry.name} {label}": v.checked for label, v in entry.verdicts.items() if v.verdict == "proved"}
    if report.certificate is None:
        return []
    unconfirmed = [name.replace("_", " ") for name, checked in proved.items() if not checked]
    confirmed = f"{len(proved) - len(unconfirmed)} of {len(proved)}"
    remarks = [Remark(confirmed, "proved claims are confirmed by the checker")]
    listed = ", ".join(unconfirmed[:_MOST_FIELDS]) + (", ..." if len(unconfirmed) > _MOST_FIELDS else "")
    return [*remarks, *([Remark("without evidence", listed)] if unconfirmed else [])]


def _because(entry: FieldVerdict, method: str) -> str:
    """Return the argument in parentheses, with the chance of an error or the gap; empty if undecided."""
    if entry.verdict == "undecided":
        return ""
    chance = f"chance of error below {entry.bound}" if entry.bound else "no evidence for the checker"
    means = chance if entry.verdict == "probable" else _gap(entry.bound or "inf", method)
    where = _NEAR.get(entry.about or "", "")
    return f" ({entry.argument}; {means}{where})"
