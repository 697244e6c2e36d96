"""The doors: `classify` tells everything of a scene, `derived_flag` one thing more."""

from __future__ import annotations

from functools import partial

from dofkit.base.arguments import require_one_of, seconds_of
from dofkit.base.deadline import DEFAULT_SECONDS, OutOfTimeError, limited
from dofkit.base.errors import ArgumentError
from dofkit.base.surface import handed_on
from dofkit.classification.study import study
from dofkit.exact.points.balls import precise_for
from dofkit.methods.in_worker import in_worker
from dofkit.methods.names import MethodName
from dofkit.methods.stages import classified
from dofkit.methods.table import METHODS
from dofkit.report import Report
from dofkit.scene.lowering import lower
from dofkit.scene.reading import SceneLike, scene_or_system
from dofkit.scene.scene import Scene
from dofkit.system import System

_UNWATCHED = "No worker process could be started here: the time was watched, but nothing would have been killed."


def classify(
    scene: SceneLike | System, budget: float | None = None, method: MethodName = "auto", certificate: bool = False
) -> Report:
    """How the system of ``scene`` can move: its freedom, labels, integrals and redundancy, each with a verdict.

    ``scene``: a Scene, a path, a catalog name, a mapping or a System.
    ``budget``: seconds for the scene; what is not finished then is undecided. The work is then done in a process of
    its own, which is killed where it does not end by itself (1 s or a quarter of the budget later), or needs too much
    memory: then everything is undecided, and the reason says so. Without a budget it is done here, and no new part of
    it is begun after 60 s. ``method``: a name of `METHODS`; one alone leaves open what it cannot answer.
    ``certificate``: with the evidence of what is proved, for `dofkit.verify`; what that refuses is undecided.
    ``certificate``: whether evidence is looked for, in a few seconds more; what it contradicts is no longer told as
    proved, and a warning says so. A System has no scene that could be read again, and gets none.
    Returns a Report: numbers of freedoms, names and texts, without units. Raises `SceneError` with every fault where
    the scene cannot be read as mathematics, and `ArgumentError` for what is no scene, no method or no number.

    >>> import dofkit
    >>> report = dofkit.classify({"coordinates": ["x", "y"], "constraints": ["x dy + y dx = 0"]})
    >>> report.dof, report.constraints[0].integral, report.verdict
    (1, 'x*y = C', 'proved')
    """
    require_one_of(method, METHODS, "method")
    given = scene_or_system(scene)
    if certificate and isinstance(given, System):
        raise ArgumentError("a certificate is of a scene: a System has no text that could be read again")
    report = _classified(given, budget, method).beside(given)
    return with_certificate(given, report) if certificate and isinstance(given, Scene) else report


def with_certificate(scene: Scene, report: Report) -> Report:
    """The report with its certificate; what a second program finds otherwise is undecided.

    It is probable where points over GF(p) alone say what the evidence does. What makes certificates is imported where
    one is asked for.
    """
    homes = {"with_certificate": "dofkit.methods.certificates.lowering"}
    again = partial(classified, scene, DEFAULT_SECONDS, "field")
    certified: Report = handed_on(__name__, homes, "with_certificate")(scene, report, again)
    return certified


def _classified(given: Scene | System, budget: float | None, method: MethodName) -> Report:
    if budget is None:
        return classified(given, DEFAULT_SECONDS, method)
    seconds = seconds_of(budget)
    report = in_worker(given, seconds, method)
    if report is not None:
        return report
    report = classified(given, seconds, method)
    return report.model_copy(update={"warnings": [*report.warnings, _UNWATCHED]})


def derived_flag(scene: SceneLike | System, budget: float | None = None) -> list[int] | None:
    """The ranks of the codistribution I, of I', I'', ... down to its largest integrable part, at a generic point.

    I is spanned by the differentials of the finite relations and the Pfaffian forms of ``scene``; I' holds the forms
    of I whose differential vanishes modulo I. None where that is not certain in the time there is (no new part of the
    work is begun after it), or a relation is nonlinear in the velocities. Probable: exact arithmetic at random points.
    ``scene`` and ``budget`` (seconds) are as for `classify`, and so are the errors that are raised.

    >>> import dofkit
    >>> dofkit.derived_flag({"coordinates": ["x", "y", "z"], "constraints": ["dz = y dx"]})
    [1, 0]
    """
    seconds = DEFAULT_SECONDS if budget is None else seconds_of(budget)
    given = scene_or_system(scene)
    system = given if isinstance(given, System) else lower(given)
    try:
        with limited(seconds), precise_for(system.longest):
            outcome = study(system, flag=True).outcome
    except OutOfTimeError:
        return None
    ranks = [a.derived for a in outcome.answers]
    if not outcome.consistent or any(b.nonlinear for b in outcome.blocks):
        return None
    known = [r for r in ranks if r is not None]
    if len(known) < len(ranks):
        return None
    return [sum(r[min(k, len(r) - 1)] for r in known) for k in range(max(map(len, known), default=0))]
