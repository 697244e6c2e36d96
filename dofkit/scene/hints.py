"""What to do about a fault of a scene, where the fault itself does not say it."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace

from dofkit.base.errors import Fault

UNKNOWN_KEY = "unknown key"
_HINTS = (
    (r"needs '(\w+)'", "add '{0}: ...'"),
    (r"^a list is needed", "write it in square brackets, [a, b]"),
    (r"^a mapping is needed", "write it as 'key: value', or in braces"),
    (r"^a text is needed", "put it in double quotes"),
    (r"is 1, 2 or 3", "write 1, 2 or 3"),
    (r"number", "write a number such as 2, 0.5 or 1e-3"),
    (r"^at (?:least|most) \d+ entries", "add or take away entries"),
)


def without_echoes(faults: Iterable[Fault]) -> list[Fault]:
    """The faults less those that a misspelt key explains: the key that it should have been is not missing."""
    faults = list(faults)
    meant = {
        (fault.where[:-1], match[1])
        for fault in faults
        if fault.message.startswith(UNKNOWN_KEY) and (match := re.fullmatch(r"did you mean '(.*)'\?", fault.hint or ""))
    }
    return [
        fault
        for fault in faults
        if not (fault.where and "needs" in fault.message and (fault.where[:-1], fault.where[-1]) in meant)
    ]


def with_hint(fault: Fault) -> Fault:
    """A fault that says which field it is about, and what to do."""
    message, keys = (
        re.sub(r"^Input should be (.*)", r"\1 is needed", fault.message),
        [key for key in fault.where if isinstance(key, str)],
    )
    if len(fault.where) > 2 and keys[-1] not in ("text", "name", "type") and keys[-1] not in message:
        message = f"`{keys[-1]}`: {message}"
    return replace(fault, message=message, hint=fault.hint or _hint(fault.message))


def _hint(message: str) -> str:
    for pattern, hint in _HINTS:
        match = re.search(pattern, message)
        if match:
            return hint.format(*match.groups())
    return "'dofkit schema' lists what can stand here"
