"""A case answered: here, or in a process of its own that is ended where it does not end by itself."""

from __future__ import annotations

import resource
import signal
import traceback
from collections.abc import Mapping
from functools import cache
from multiprocessing import get_context
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, Literal, NamedTuple

import dofkit
from dofkit.base.deadline import by_processor

from .judgement import Recheck, rechecked

#: Seconds of processor time for one scene; past them it has a quarter more, and then is ended. Bytes of memory.
SECONDS, MEMORY = 60.0, 6 << 30


class Answer(NamedTuple):
    """``report`` as JSON where there is one; else ``why`` not, and the end: a scene that is refused, as too large to
    read, is no fault; an error, a time that was overrun and a process that broke are. ``checked``: by the checker."""

    end: Literal["told", "refused", "failed", "late", "killed"]
    report: Mapping[str, Any] | None
    why: str = ""
    checked: Recheck = Recheck()


def answered(scene: Mapping[str, Any], seconds: float = SECONDS, *, certificates: bool = False) -> Answer:
    """The report, from this process; its time is counted by the processor. ``certificates``: the checker's word too."""
    try:
        with by_processor(seconds):
            report = dofkit.classify(dict(scene), certificate=certificates)
        checked = rechecked(scene, report) if certificates else Recheck()
        return Answer("told", report.model_dump(mode="json", exclude={"certificate"}), checked=checked)
    except dofkit.SceneError as error:
        return Answer("refused", None, str(error))
    except Exception as error:
        where = traceback.extract_tb(error.__traceback__)[-1]
        return Answer("failed", None, f"{type(error).__name__}: {error} ({Path(where.filename).stem}.{where.name})")


def answered_apart(scene: Mapping[str, Any], seconds: float = SECONDS, *, certificates: bool = False) -> Answer:
    """The report, from a process of its own, a copy of this one."""
    _warm()
    context = get_context("fork")
    receiver, sender = context.Pipe(duplex=False)
    child = context.Process(target=_answer, args=(scene, seconds, sender, certificates))
    child.start()
    sender.close()
    try:
        found: Answer = receiver.recv()
    except EOFError:
        child.join()
        late = child.exitcode == -signal.SIGXCPU
        found = Answer("late" if late else "killed", None, f"the process ended with {child.exitcode}")
    child.join()
    return found


#: Scenes that have all that is imported late imported.
_WARM: tuple[Mapping[str, Any], ...] = (
    {"coordinates": ["x", "y", "z"], "constraints": ["dz = sin(y)*dx", "x^2 + y^2 = 1"]},
    {"coordinates": ["x", "y"], "constraints": ["y = exp(x) + sqrt(2)", "x^3 + 2*x*y = 7"]},
    {"dimension": 2, "bodies": ["a"], "constraints": [{"type": "revolute", "between": ["ground", "a"], "at": [0, 0]}]},
    {"coordinates": ["x", "y"], "constraints": ["(x^2 + y^2)*(x - 1) = 0", "abs(x) <= 2"]},
)


@cache
def _warm() -> None:
    """Import here what a copy would else import again."""
    for scene in _WARM:
        answered(scene, certificates=True)


def _answer(scene: Mapping[str, Any], seconds: float, sender: Connection, certificates: bool) -> None:
    most = int(1.25 * seconds) + 2
    resource.setrlimit(resource.RLIMIT_CPU, (most, most + 5))
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    sender.send(answered(scene, seconds, certificates=certificates))
