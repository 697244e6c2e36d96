"""Evidence for appeals: of every problem the certificate of what its key rests on."""

from __future__ import annotations

import json
from pathlib import Path
from urllib.parse import quote

from dofkit.homework.assignment import Prepared
from dofkit.methods.classify import with_certificate


def write_certificates(prepared: Prepared, folder: Path) -> list[Path]:
    """Write a certificate of each problem's scene, called by the problem, for `dofkit.verify`; the paths written.

    The key's numbers and labels are the report's; of answers in equations it says nothing. Raises OSError.
    """
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for name, key in prepared.keys.items():
        path = folder / f"{quote(name, safe='')}.json"
        certificate = with_certificate(key.scene, key.report).certificate
        path.write_text(json.dumps(certificate, ensure_ascii=False) + "\n", encoding="utf-8")
        written.append(path)
    return written
