"""The report on equations of motion. Field names are fixed; see the docstrings."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

from pydantic import Field, PrivateAttr

from dofkit.base.display import DisplayedFormulas, text_of
from dofkit.base.verdicts import Verdict
from dofkit.report import Companion, Report, ReportModel

if TYPE_CHECKING:
    from dofkit.motion.lagrange.derivation import Derived

#: T, V and L are energies, so that every q p has the dimension of energy times time.
QP = "action, M L^2 T^-1: each product q*p has the dimension of energy times time, whatever q is"


class Conserved(ReportModel):
    """A quantity that is constant along the motion: its name, its formula, and the reason."""

    name: str
    quantity: str
    reason: str


class Linearized(ReportModel):
    """M qddot + C qdot + K q = 0 for small deviations q of ``coordinates`` from an equilibrium.

    ``characteristic``: det(M s^2 + C s + K), empty for large systems; ``frequencies``: angular frequencies as texts, if
    C is 0, all are real and have formulas, else empty. ``unstable``: whether some deviation grows; null if that is not
    known.
    """

    coordinates: list[str]
    equilibrium: dict[str, str]
    mass: list[list[str]]
    damping: list[list[str]]
    stiffness: list[list[str]]
    characteristic: str
    frequencies: list[str]
    unstable: bool | None = None


class MotionReport(DisplayedFormulas, ReportModel):
    """Lagrange's equations of a scene, as texts in the grammar of scenes (``qddot`` for accelerations).

    ``coordinates`` are the remaining ones; ``eliminated``: the others as functions of these. ``forces``: dL/dq plus the
    non-conservative forces; ``equations`` end in ``= 0``, one for each coordinate; ``constraints``: those that keep a
    multiplier, in the order of ``multipliers``; ``left_out``: redundant ones. ``non_conservative``: the coordinates
    with a force that is not part of the Lagrangian. ``cyclic``: coordinates that do not occur in the Lagrangian.
    ``verdict``: how certain the classification of the constraints is.
    """

    _in_brief: ClassVar[tuple[str, ...]] = ("scene", "equations", "verdict")

    scene: str
    coordinates: list[str]
    lagrangian: str
    momenta: dict[str, str]
    forces: dict[str, str]
    equations: list[str]
    constraints: list[str]
    multipliers: list[str]
    eliminated: dict[str, str] = Field(default_factory=dict)
    left_out: list[str] = Field(default_factory=list)
    non_conservative: list[str] = Field(default_factory=list)
    cyclic: list[str] = Field(default_factory=list)
    conserved: list[Conserved] = Field(default_factory=list)
    action: str = QP
    linearized: Linearized | None = None
    notes: list[str] = Field(default_factory=list)
    verdict: Verdict = "proved"
    _derived: Derived | None = PrivateAttr(None)
    _companion: Companion = PrivateAttr(default_factory=Companion)

    def text(self, width: int | None = None) -> str:
        """Return what the command line prints; long lines are not broken, so that equations can be copied."""
        return text_of(self, width)

    @property
    def classification(self) -> Report:
        """The classification report on which the equations depend. Raises ValueError if this report was read back."""
        return self._derivation.model.study.report

    @property
    def _derivation(self) -> Derived:
        if self._derived is None:
            raise ValueError("this report was read back as text: derive it again by dofkit.lagrange(scene)")
        return self._derived

    def to_sympy(self) -> Any:
        """Return SymPy's LagrangesMethod for the remaining coordinates; its equations are not yet formed.

        Raises ValueError for a report that was read back and not derived here.
        """
        return self._derivation.sympys_method()
