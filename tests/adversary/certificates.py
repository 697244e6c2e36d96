"""The checker asked as well: of what a report proves, what does its certificate have a second program believe?"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from dofkit.checker import CheckError, verify
from dofkit.report import Report

#: What the warning of a claim says that was lowered.
CONTRADICTED = "a second program finds otherwise"


class Recheck(NamedTuple):
    """``verified``: fields as a case's truth names them; ``faults``: claims that are refused, with why."""

    verified: frozenset[str] = frozenset()
    faults: Mapping[str, str] = {}


def rechecked(scene: Mapping[str, Any], report: Report) -> Recheck:
    """What the checker says of a report with its certificate; the scene is read again from what was written."""
    certificate = report.certificate or {"claims": []}
    told = {f"contradicted {i}": text for i, text in enumerate(report.warnings) if CONTRADICTED in text}
    if not certificate["claims"]:
        return Recheck(frozenset(), told)
    try:
        found = verify(dict(scene), certificate)
    except CheckError as error:
        return Recheck(frozenset(), {**told, "no certificate": str(error)})
    failed = {one["path"]: f"{one['rule']}: {one['why']}" for one in found.failed}
    paths = [claim["path"] for claim in certificate["claims"] if claim["path"] not in failed]
    faults = {f"unverified {field_of(path)}": why for path, why in failed.items()}
    return Recheck(frozenset(map(field_of, paths)), {**told, **faults})


def field_of(path: str) -> str:
    """A path of a certificate as a case's truth names the field: ``dof``, ``c1.holonomic``."""
    parts = [part.replace("~1", "/").replace("~0", "~") for part in path.split("/")[1:]]
    return ".".join(parts[1:]) if parts[0] == "constraints" else ".".join(parts)
