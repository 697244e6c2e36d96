"""The arguments that answers rest on: what each shows, from which hypotheses, and which function checks these.

Every decided answer names a row of `arguments.yaml`; `dofkit.base.verdicts.Claim` enforces this.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import NamedTuple

from dofkit.base.documents import package_table
from dofkit.base.verdicts import ArgumentKey


class Argument(NamedTuple):
    """An argument: what it ``claims``, its ``hypotheses`` in words, and the function by which they are ``checked_by``.

    ``theorem`` is a key of `THEOREMS.md`, "" for a definition or a count.
    """

    claims: str
    hypotheses: str
    checked_by: str
    theorem: str = ""


@cache
def arguments() -> Mapping[ArgumentKey, Argument]:
    """Return the arguments by their keys."""
    return {key: Argument(**row) for key, row in package_table(__package__, "arguments.yaml").items()}
