"""Evidence for appeals: of every problem the certificate of what its key rests on."""

from __future__ import annotations

import json
from pathlib import Path
from urllib.parse import quote

from dofkit.homework.assignment import Prepared
from dofkit.homework.formats.wording import FileNames
from dofkit.homework.own_sheets import own
from dofkit.methods.classify import with_certificate


def write_certificates(prepared: Prepared, folder: Path) -> list[Path]:
    """Write a certificate of each problem's scene, called by the problem, for `dofkit.verify`; the paths written.

    The key's numbers and labels are the report's; of answers in equations it says nothing. Where every student has a
    sheet of their own, each has a folder. Raises OSError.
    """
    if prepared.assignment.variants is not None:
        names = FileNames()
        sheets = [(names.of(one.student), own(prepared, one.student)) for one in prepared.assignment.variants.students]
        return [path for name, sheet in sheets for path in write_certificates(sheet, folder / name)]
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for name, key in prepared.keys.items():
        path = folder / f"{quote(name, safe='')}.json"
        certificate = with_certificate(key.scene, key.report).certificate
        path.write_text(json.dumps(certificate, ensure_ascii=False) + "\n", encoding="utf-8")
        written.append(path)
    return written
