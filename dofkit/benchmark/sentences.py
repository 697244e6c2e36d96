"""Sentences about the data of a run, for captions and the terminal, and about why a method fails on a trial."""

from __future__ import annotations

from dofkit.base.documents import package_table
from dofkit.base.wording import sentence
from dofkit.benchmark.record import AUTO, Data
from dofkit.benchmark.statistics import against, scores
from dofkit.methods.table import methods

#: `auto` should take at most this many times the time of the fastest method that is right.
TWICE = 2


def caption(figure: str, data: Data) -> str:
    """Return the caption of a figure: what it shows, the run and its machine, and the command."""
    ran, words = data.ran, package_table(__package__, "captions.yaml")[figure]
    return (
        f"{words} {ran.trials} trials whose answers are known by construction, at most {ran.limit:g} s of "
        f"processor time each; dofkit {ran.version}, Python {ran.python}, {ran.machine}, {ran.cores} cores, "
        f"{ran.date[:10]}. Made by: {ran.command}"
    )


def sentences(data: Data) -> list[str]:
    """Return sentences on how often ``auto`` is right and how long it takes, as far as there are data."""
    return [text for text in (_trials(data), _time(data)) if text]


def _trials(data: Data) -> str:
    """Return the sentence on the answers of ``auto``, empty if it was not run."""
    by_method = scores(data.lines)
    if AUTO not in by_method:
        return ""
    auto = by_method[AUTO]
    number = auto.counts.get("wrong", 0)
    wrong = f"{number} {'is' if number == 1 else 'are'}" if number else "none is"
    trials = f"{data.ran.trials:,}".replace(",", " ")
    return (
        f"{trials} trials by {len(by_method)} methods, at most {data.ran.limit:g} s each: of the answers of `auto` "
        f"{wrong} wrong and {percent(auto.share_unanswered, 'less than ', 'more than ')} are undecided."
    )


def _time(data: Data) -> str:
    """Return the sentence on the times of ``auto``, empty if there is no other method that is right."""
    rows = against(data.lines)
    sound = [row.sound_ratio for row in rows if row.sound_ratio is not None]
    if not sound:
        return ""
    within, lucky = sum(ratio <= TWICE for ratio in sound), sum(row.ratio <= TWICE for row in rows)
    where = "On every family" if within == len(sound) else f"On {within} of {len(sound)} families"
    return (
        f"{where} `auto` takes at most twice the time of the fastest method that is right there and wrong nowhere; "
        f"with those that are right there by luck it does on {lucky} of {len(rows)}."
    )


def percent(share: float, below: str = "<", above: str = ">") -> str:
    """Return a share in per cent, rounded, but to 0 or 100 only if it is exactly that.

    >>> percent(0.5), percent(0.0004), percent(0.9996), percent(1.0)
    ('50 %', '<0.1 %', '>99.9 %', '100 %')
    """
    value = 100 * share
    if 0 < value < 0.1:
        return f"{below}0.1 %"
    if 99.9 < value < 100:
        return f"{above}99.9 %"
    return f"{value:.1f} %" if 0 < value < 10 or 90 < value < 100 else f"{value:.0f} %"


def explained(method: str, question: str, outcome: str, reason: str = "") -> str:
    """Return sentences on why a method fails: its own ``reason``, or what it never answers.

    ``outcome`` is ``wrong``, ``undecided``, ``cannot`` or ``timed out``; for the last the method's cost is added.
    """
    row = next((row for name, row in methods().items() if name == method), None)
    cannot = f"{method} does not answer this" if row is None else row.cannot
    uses = row.uses.items() if row is not None and outcome == "timed out" else ()
    return " ".join([sentence(reason or cannot), *(f"Its cost: {use.costs}." for q, use in uses if q == question)])
