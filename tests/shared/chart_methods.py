"""Methods for the tests of the charts: one of each kind, without mechanics. ``size`` in the scene is what they cost."""

from __future__ import annotations

import ctypes
import os
from collections.abc import Iterator, Mapping
from typing import Any

from dofkit.benchmark.trials.construction import Trial
from dofkit.methods.table import Reply


def answered(scene: Mapping[str, Any], question: str, method: str, answer: Mapping[str, str] | None) -> Reply:
    """What each of them tells; the truth is 2."""
    del question, answer
    size = scene.get("size", 1)
    if method == "hangs" and size > 2:
        while True:
            pass
    if method == "deaf" and size == 8 and scene["k"]:
        sum(range(10**11))
    if method == "crashes" and size == 2:
        ctypes.string_at(0)
    if method == "raises":
        raise KeyError("x")
    if method == "process":
        return Reply(os.getpid())
    told = {"wrong": 3, "undecided": None, "cannot": None}.get(method, 2)
    return Reply(told, reason="" if told else f"it is {method}", cannot=method == "cannot")


def family() -> Iterator[Trial]:
    """Four sizes, two trials each."""
    for size in (4, 1, 2, 8):
        for k in range(2):
            scene = {"coordinates": ["x"], "constraints": [], "size": size, "k": k}
            yield Trial("boxes", f"box-{size}-{k}", "dof", scene, 2, "by construction", size)
