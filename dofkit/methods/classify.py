"""Entry points: `classify` reports everything about a scene, `derived_flag` the ranks of its derived flag."""

from __future__ import annotations

import sys
from dataclasses import replace
from typing import overload

from dofkit.base.deadline import DEFAULT_SECONDS, OutOfTimeError, limited
from dofkit.base.errors import ArgumentError, Fault, SceneError
from dofkit.base.wording import require_one_of, seconds_of
from dofkit.classification.study import study
from dofkit.exact.points.balls import precise_for
from dofkit.methods.stages import classified
from dofkit.methods.table import METHODS, MethodName
from dofkit.report import Report
from dofkit.scene.lowering import lower
from dofkit.scene.reading import SceneLike, scene_or_system
from dofkit.scene.scene import Scene
from dofkit.system import System

#: Several scenes at once.
Scenes = list[SceneLike | System] | tuple[SceneLike | System, ...]

_UNWATCHED = "No worker process could be started here: the time was watched, but nothing would have been killed."


@overload
def classify(
    scene: SceneLike | System, budget: float | None = None, method: MethodName = "auto", certificate: bool = False
) -> Report: ...


@overload
def classify(
    scene: Scenes, budget: float | None = None, method: MethodName = "auto", certificate: bool = False
) -> list[Report]: ...


def classify(
    scene: SceneLike | System | Scenes,
    budget: float | None = None,
    method: MethodName = "auto",
    certificate: bool = False,
) -> Report | list[Report]:
    """Return how a system can move: degrees of freedom, labels, integrals and redundancy, each with a verdict.

    Parameters
    ----------
    scene
        A Scene, a path, a catalog name, a mapping or a System; or a list or tuple of these.
    budget
        Seconds for each scene. The work is then done in a process of its own, which is killed if it does not end or
        needs too much memory; what is not finished is undecided. Without a budget no new step begins after 60 s.
    method
        ``"auto"``, or one method on its own, which leaves undecided what it cannot answer.
    certificate
        Whether to add the evidence for `verify`; an answer that the evidence contradicts becomes undecided.

    Returns
    -------
    Report or list of Report
        Numbers of freedoms are whole numbers without a unit; equations are texts. A list gives a list, in order.

    Raises
    ------
    SceneError
        If a scene cannot be read. All scenes of a list are read first, and all their faults are raised at once.
    ArgumentError
        If an argument is no scene, no method or no number of seconds.

    Examples
    --------
    >>> import dofkit
    >>> report = dofkit.classify({"coordinates": ["x", "y"], "constraints": ["x dy + y dx = 0"]})
    >>> report.dof, report.constraints[0].integral, report.verdict
    (1, 'x*y = C', 'proved')
    >>> [report.dof for report in dofkit.classify(["four-bar-linkage", "disc-rolling-on-plane"])]
    [1, 4]
    """
    require_one_of(method, METHODS, "method")
    if isinstance(scene, list | tuple):
        return [_certified(loaded, budget, method, certificate) for loaded in _all_read(scene)]
    return _certified(scene_or_system(scene), budget, method, certificate)


def _all_read(scenes: Scenes) -> list[Scene | System]:
    """Read every scene. Raises one SceneError with the faults of all, each located by the position of its scene."""
    read: list[Scene | System] = []
    faults: list[Fault] = []
    for position, scene in enumerate(scenes):
        try:
            read.append(scene_or_system(scene))
        except SceneError as error:
            source = f"{error.source}: " if error.source else ""
            faults += [
                replace(fault, message=source + fault.message, where=(position, *fault.where)) for fault in error.faults
            ]
    if faults:
        raise SceneError(tuple(faults))
    return read


def _certified(loaded: Scene | System, budget: float | None, method: MethodName, certificate: bool) -> Report:
    if not certificate:
        return _classified(loaded, budget, method).with_scene(loaded)
    if isinstance(loaded, System):
        raise ArgumentError("a certificate needs a Scene: a System has no text that the checker could read")
    from dofkit.methods.certificates.lowering import with_certificate

    return with_certificate(loaded, _classified(loaded, budget, method).with_scene(loaded))


def _classified(loaded: Scene | System, budget: float | None, method: MethodName) -> Report:
    if budget is None:
        return classified(loaded, DEFAULT_SECONDS, method)
    seconds = seconds_of(budget)
    if sys.platform != "emscripten":  # a browser has no processes
        from dofkit.methods.supervised import report_from_worker

        report = report_from_worker(loaded, seconds, method)
        if report is not None:
            return report
    report = classified(loaded, seconds, method)
    return report.model_copy(update={"warnings": [*report.warnings, _UNWATCHED]})


def strict_report(scene: Scene) -> Report:
    """Return the report in which what is proved was checked; in a browser, which has no checker, the plain one."""
    if sys.platform == "emscripten":
        return classify(scene)
    from dofkit.methods.certificates.lowering import with_certificate

    return with_certificate(scene, classify(scene), strict=True)


def derived_flag(scene: SceneLike | System, budget: float | None = None) -> list[int] | None:
    """Return the ranks of I, I', I'', ... at a generic point, down to the largest integrable part.

    The codistribution I is spanned by the differentials of the holonomic equations and by the Pfaffian forms of the
    scene; I' consists of the forms w in I with dw = 0 modulo I. The ranks are computed by exact arithmetic at random
    points (``probable``).

    Parameters
    ----------
    scene, budget
        As for `classify`; no new step begins after ``budget`` seconds.

    Returns
    -------
    list of int, or None
        None if a constraint is nonlinear in the velocities, or the ranks were not decided in time.

    Raises
    ------
    SceneError, ArgumentError
        As for `classify`.

    References
    ----------
    G. Frobenius, Ueber das Pfaffsche Problem, 1877: the last I is integrable.

    Examples
    --------
    >>> import dofkit
    >>> dofkit.derived_flag({"coordinates": ["x", "y", "z"], "constraints": ["dz = y dx"]})
    [1, 0]
    """
    seconds = DEFAULT_SECONDS if budget is None else seconds_of(budget)
    loaded = scene_or_system(scene)
    system = loaded if isinstance(loaded, System) else lower(loaded)
    try:
        with limited(seconds), precise_for(system.longest):
            outcome = study(system, flag=True).outcome
    except OutOfTimeError:
        return None
    ranks = [a.derived for a in outcome.answers]
    if not outcome.consistent or any(b.nonlinear for b in outcome.blocks):
        return None
    decided = [r for r in ranks if r is not None]
    if len(decided) < len(ranks):
        return None
    return [sum(r[min(k, len(r) - 1)] for r in decided) for k in range(max(map(len, decided), default=0))]
