"""What was answered wrongly, kept as a test: the scene, its truth, and what was told."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any

from dofkit.benchmark.trials.construction import KnownScene

from .judgement import judged, overall
from .running import SECONDS, Answer, answered_apart
from .trial import Trial, made

FOUND = Path(__file__).parent / "found"


def faults(case: KnownScene, answer: Answer) -> dict[str, Any]:
    """The fields that are answered wrongly with what was told; or the end, where there is no report.

    Where the checker was asked, ``certified FIELD``: wrong, and its certificate verifies; and the claims it refuses.
    """
    if answer.report is None:
        return {} if answer.end == "refused" else {answer.end: answer.why}
    wrong = [one for one in judged(case, answer.report) if one.outcome == "wrong"]
    sure = {one.field for one in wrong if one.verdict == "proved"} & answer.checked.verified
    told = {f"{'certified ' * (one.field in sure)}{one.field}": f"{one.told} ({one.verdict})" for one in wrong}
    return {**told, **answer.checked.faults}


def outcome(case: KnownScene, answer: Answer) -> str:
    """``right``, ``undecided``, ``wrong``, or how it ended without a report."""
    return answer.end if answer.report is None else overall(judged(case, answer.report))


def fails_alike(trial: Trial, fields: frozenset[str], seconds: float = SECONDS, *, certificates: bool = False) -> bool:
    """Is one of these fields answered wrongly again?"""
    case = made(trial)
    return bool(fields & faults(case, answered_apart(case.scene, seconds, certificates=certificates)).keys())


def kept(trial: Trial, told: dict[str, Any], folder: Path = FOUND) -> Path:
    """Write the case into a file of the folder."""
    case = made(trial)
    fields = {
        "kind": trial.kind,
        "trial": str(trial),
        "scene": case.scene,
        "truth": dict(case.truth),
        "elsewhere": {key: [*values] for key, values in case.elsewhere.items()},
        "told": told,
    }
    text = json.dumps(fields, indent=1, ensure_ascii=False)
    mark = hashlib.sha256(json.dumps(case.scene, sort_keys=True).encode()).hexdigest()[:8]
    path = folder / f"{trial.kind.replace('/', '-')}-{mark}.json"
    path.write_text(text + "\n", encoding="utf-8")
    return path


def read(path: Path) -> tuple[str, KnownScene]:
    """The kind and the case of such a file."""
    fields = json.loads(path.read_text(encoding="utf-8"))
    return fields["kind"], KnownScene(fields["scene"], fields["truth"], fields["elsewhere"])
