"""The answers of a scene, each worked out when it is first asked for."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal

from dofkit.base.errors import DofkitError
from dofkit.classification.dependence.equivalence import Compared
from dofkit.expressions.text import Names
from dofkit.homework.answers.declared import DeclaredNames
from dofkit.homework.key.right_motion import RightMotion, right_motion_or_why
from dofkit.methods.classify import classify
from dofkit.report import ConstraintEntry, Report
from dofkit.scene.constraints.base import Equation
from dofkit.scene.names import coordinate_table
from dofkit.scene.scene import Scene

#: A question about a set of names of a scene, whose report is known.
Chosen = Callable[[Scene, Sequence[str], Report], bool | None]
#: Sets of names whose answers are kept.
MOST_KNOWN = 4096
#: Scenes with coordinates of answers' own that are kept.
MOST_EXTENDED = 256

#: Names of constraints, the equations beside them, and their constants.
ComparedTexts = tuple[tuple[str, ...], tuple[str, ...], frozenset[str]]
Convention = Literal["configuration", "velocity"]


@dataclass(frozen=True)
class Key:
    """What is right for one problem. ``convention``: what "degrees of freedom" means.

    ``also``: further coordinates that an answer may use, and what they are. ``others``: other name -> declared name.
    ``base``: the key without the coordinates of an answer's own.
    """

    scene: Scene
    convention: Convention = "configuration"
    also: Mapping[str, str] = field(default_factory=dict)
    others: Mapping[str, str] = field(default_factory=dict)
    base: Key | None = field(default=None, repr=False)

    @cached_property
    def report(self) -> Report:
        """What dofkit says of the scene. An answer's own coordinates, each with its equation, leave that as it is."""
        return classify(self.scene) if self.base is None else self.base.report

    @cached_property
    def _known(self) -> dict[tuple[Chosen, frozenset[str]], bool | None]:
        return {}

    def known(self, what: Chosen, names: Iterable[str]) -> bool | None:
        """``what(scene, names, report)``, worked out once for every set of names, in whatever order they come."""
        chosen = frozenset(names)
        if (what, chosen) not in self._known:
            found = what(self.scene, sorted(chosen), self.report)
            if len(self._known) == MOST_KNOWN:
                return found
            self._known[what, chosen] = found
        return self._known[what, chosen]

    @cached_property
    def _compared(self) -> dict[ComparedTexts, Compared]:
        return {}

    def compared(self, texts: ComparedTexts, compare: Callable[[], Compared]) -> Compared:
        """What equations come to beside the constraints, worked out once for all who write the same in other ways."""
        known = self._compared.get(texts)
        if known is None:
            known = compare()
            if len(self._compared) < MOST_KNOWN:
                self._compared[texts] = known
        return known

    @cached_property
    def _implied(self) -> dict[str, bool]:
        return {}

    def implied(self, text: str, decide: Callable[[], bool]) -> bool:
        """Does a relation follow from the scene's constraints? Worked out once for each text."""
        known = self._implied.get(text)
        if known is None:
            known = decide()
            if len(self._implied) < MOST_KNOWN:
                self._implied[text] = known
        return known

    @cached_property
    def declared(self) -> DeclaredNames:
        """What an answer's texts may mention."""
        return DeclaredNames.of(self.scene, self.also, self.others)

    @property
    def names(self) -> Names:
        """The names of formulas."""
        return self.declared.names

    @cached_property
    def coordinates(self) -> list[str]:
        """The scene's configuration coordinates, in order."""
        return [c.name for c in coordinate_table(self.scene).coordinates]

    @cached_property
    def _extended(self) -> dict[tuple[tuple[str, ...], tuple[str, ...]], Key]:
        return {}

    def with_own(self, names: tuple[str, ...], texts: tuple[str, ...]) -> Key:
        """The same of the scene with further coordinates, and equations that say what they are."""
        if (names, texts) not in self._extended:
            more = tuple(Equation(name=f"own {i + 1}", text=text) for i, text in enumerate(texts))
            scene = self.scene.model_copy(
                update={
                    "coordinates": (*self.scene.coordinates, *names),
                    "constraints": (*self.scene.constraints, *more),
                    "expect": {},
                }
            )
            key = Key(scene, self.convention, others=self.others, base=self)
            if len(self._extended) == MOST_EXTENDED:
                return key
            self._extended[names, texts] = key
        return self._extended[names, texts]

    @cached_property
    def motion(self) -> RightMotion | DofkitError:
        """What is right of the equations of motion, or why that is not known."""
        return right_motion_or_why(self.scene)

    @cached_property
    def whole_motion(self) -> RightMotion | DofkitError:
        """The same with nothing eliminated: every constraint keeps its multiplier."""
        return right_motion_or_why(self.scene, whole=True)

    @cached_property
    def constraints(self) -> dict[str, ConstraintEntry]:
        """The entries of the report by name."""
        return {entry.name: entry for entry in self.report.constraints}
