"""Certificates by hand, those that hold and those that are forged: each in a table of ``claims/``, as what it is.

An entry has a scene, claims and the parts of a certificate. All claims are verified, or those of ``refused`` are not
(``why``: words of the reason for the last). ``verified with`` and ``refused with`` list edits: new values at
paths of keys, and what is left out (``without``); ``refused``: exactly these claims, where there are several.
"""

from __future__ import annotations

from collections.abc import Iterator
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest
import yaml
from checker.certified import faults

Entry = dict[str, Any]
TABLES = sorted((Path(__file__).parent / "claims").glob("*.yaml"))
#: The tables are read by every worker, and in pure Python that takes seconds.
LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
#: What an entry says of its certificate.
SAID = ("name", "because", "refused", "why", "verified with", "refused with")


def entries() -> Iterator[Any]:
    for path in TABLES:
        for entry in yaml.load(path.read_text(encoding="utf-8"), LOADER):
            yield pytest.param(entry, id=f"{path.stem}: {entry['name']}")


def edited(certificate: Entry, edit: Entry) -> Entry:
    """A copy with the edit's values at their paths, and without what it leaves out."""
    made = deepcopy(certificate)
    values = {path: value for path, value in edit.items() if path not in ("without", "refused", "why")}
    for path in (*values, *edit.get("without", [])):
        *above, last = path.split("/")
        place: Any = made
        for key in above:
            place = place[int(key) if isinstance(place, list) else key]
        if path in values:
            place[int(last) if isinstance(place, list) else last] = values[path]
        else:
            del place[last]
    return made


def refused(certificate: Entry) -> dict[str, str]:
    """The claims that are refused, and why."""
    parts = {key: value for key, value in certificate.items() if key not in ("scene", "claims")}
    return faults(certificate["scene"], certificate["claims"], **parts)


@pytest.mark.parametrize("entry", list(entries()))
def test_what_holds_is_verified_and_what_is_forged_is_refused(entry: Entry) -> None:
    certificate = {key: value for key, value in entry.items() if key not in SAID}
    failed = refused(certificate)
    assert list(failed) == entry.get("refused", [])
    assert entry.get("why", "") in "".join(list(failed.values())[-1:])
    for edit in entry.get("verified with", []):
        assert refused(edited(certificate, edit)) == {}, edit
    for edit in entry.get("refused with", []):
        failed = refused(edited(certificate, edit))
        assert list(failed) == edit.get("refused", list(failed))
        assert failed, edit
        assert edit.get("why", "") in list(failed.values())[-1]
