"""Gradescope's export of submissions: a folder for each, and beside them a table of whose each is."""

from __future__ import annotations

import os
import re
from functools import lru_cache

from dofkit.homework.answers.roster import Participant
from dofkit.homework.answers.submission import MOST_BYTES, clean

#: What stands beside the folders, and says of each who handed it in.
METADATA = "submission_metadata.yml"
_SAID = re.compile(
    r"^(?P<folder>submission_\d+):|^  :(?P<block>\w+):|^\s+(?P<next>- )?:(?P<what>name|email|sid): *(?P<said>.*)$",
    re.MULTILINE,
)


@lru_cache(maxsize=4)
def submitters(source: str) -> dict[str, tuple[Participant, ...]]:
    """Of every folder of an export those who handed it in, each called by the address, else by the name."""
    try:
        with open(os.path.join(source, METADATA), "rb") as file:
            text = file.read(MOST_BYTES).decode("utf-8", "replace")
    except OSError:
        return {}
    people: dict[str, list[dict[str, str]]] = {}
    folder = block = ""
    for said in _SAID.finditer(text):
        folder, block = said["folder"] or folder, said["block"] or ("" if said["folder"] else block)
        if said["what"] and folder and block == "submitters":
            known = people.setdefault(folder, [])
            if said["next"] or not known:
                known.append({})
            known[-1][said["what"]] = clean(said["said"]).strip("\"' \r")
    return {folder: found for folder, known in people.items() if (found := tuple(_participants(known)))}


def _participants(known: list[dict[str, str]]) -> list[Participant]:
    found = [(one.get("email", ""), one.get("name", ""), one.get("sid", "")) for one in known]
    return [
        Participant(email or name or number, name=name, email=email, number=number)
        for email, name, number in found
        if email or name or number
    ]
