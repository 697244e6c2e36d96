"""One certificate of the command line, from its bytes to the lines that are printed; this runs in a worker."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from dofkit.base.errors import DofkitError
from dofkit.base.workers import Json
from dofkit.checker import CheckError, Verification, verify
from dofkit.interface.supervised import CertificateGiven
from dofkit.methods.certificates import verifying
from dofkit.motion_checker import MOTION_RULES
from dofkit.scene.catalog import find

#: Exit statuses: all is well, something failed, something could not be read.
VERIFIED, REFUSED, UNREAD = 0, 1, 2


def verification_lines(given: CertificateGiven) -> Json:
    """What is printed of a certificate, and the exit status."""
    try:
        found = _verified(given)
    except OSError as error:
        return _unread(given, f"it cannot be read: {error.strerror or error}")
    except (CheckError, DofkitError, ValueError) as error:
        return _unread(given, " ".join(str(error).split()))
    refused = bool(found.failed) or (given.strict and bool(found.uncovered))
    out = json.dumps(found._asdict(), ensure_ascii=given.ascii_only) if given.as_json else _text(found)
    return {"out": out + "\n", "err": "", "status": REFUSED if refused else VERIFIED}


def _verified(given: CertificateGiven) -> Verification:
    """The checker by itself; a scene that it cannot read may be in other words, and is given in the standard ones."""
    certificate = Path(given.certificate).read_bytes()
    if given.scene is None:
        return verify(None, certificate, MOTION_RULES)
    data = find(given.scene).data
    try:
        return verify(data if isinstance(data, str) else data.decode("utf-8"), certificate, MOTION_RULES)
    except (CheckError, UnicodeDecodeError):
        return verifying.verify(given.scene, certificate)


def _unread(given: CertificateGiven, message: str) -> Json:
    if given.as_json:
        error: dict[str, Any] = {"message": message, "line": None, "column": None, "hint": None}
        line = {"scene": given.scene or given.certificate, "error": error}
        return {"out": json.dumps(line, ensure_ascii=given.ascii_only) + "\n", "err": "", "status": UNREAD}
    return {"out": "", "err": f"{given.certificate}: error: {message}\n", "status": UNREAD}


def _text(found: Verification) -> str:
    lines = [f"{found.scene}: {found.verified} of {found.claims} claims verified"]
    lines += [f"  failed     {f['path']} by {f['rule']}: {f['why']}" for f in found.failed]
    lines += [f"  uncovered  {path}" for path in found.uncovered]
    return "\n".join(lines)
