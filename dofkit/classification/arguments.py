"""The arguments by which answers are given: what each shows, from which hypotheses, and which function checks these.

An answer that is sure names a row of `arguments.yaml`: `dofkit.base.verdicts.Claim` lets none be written without.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import NamedTuple

from dofkit.base.documents import package_table
from dofkit.base.verdicts import ArgumentKey


class Argument(NamedTuple):
    """A row: what it ``claims``, the key of its ``theorem`` in `THEOREMS.md` ("" where it is a definition or a count).

    ``hypotheses`` in words; ``checked_by``: the function that checks them.
    """

    claims: str
    hypotheses: str
    checked_by: str
    theorem: str = ""


@cache
def arguments() -> Mapping[ArgumentKey, Argument]:
    """Return the arguments by their keys."""
    return {key: Argument(**row) for key, row in package_table(__package__, "arguments.yaml").items()}
