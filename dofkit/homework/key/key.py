"""The key of a problem: facts about its scene, each computed when it is first needed."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Literal, TypeVar, cast

from dofkit.base.errors import DofkitError
from dofkit.homework.answers.declared import DeclaredNames
from dofkit.homework.key.right_motion import RightMotion, right_motion_or_why
from dofkit.methods.classify import strict_report
from dofkit.report import ConstraintEntry, Report
from dofkit.scene.constraints.base import Equation
from dofkit.scene.lowering import lower
from dofkit.scene.names import coordinate_table
from dofkit.scene.scene import Scene
from dofkit.system import System

#: A question about a set of names of a scene with its report; None: undecided.
Chosen = Callable[[Scene, Sequence[str], Report], bool | None]
#: The most results about a scene that are kept.
MOST_KEPT = 4096
Answer = TypeVar("Answer")
Convention = Literal["configuration", "velocity"]


@dataclass(frozen=True)
class Key:
    """The right answers to one problem. ``convention``: what "degrees of freedom" means.

    ``also``: {further coordinate that an answer may use: its definition}.
    ``base``: the key without the coordinates that an answer introduces.
    """

    scene: Scene
    convention: Convention = "configuration"
    also: Mapping[str, str] = field(default_factory=dict)
    base: Key | None = field(default=None, repr=False)

    @cached_property
    def report(self) -> Report:
        """The strict report of the scene, without coordinates that an answer introduces."""
        return strict_report(self.scene) if self.base is None else self.base.report

    @cached_property
    def system(self) -> System:
        """The system of the scene."""
        return lower(self.scene)

    @cached_property
    def _answers(self) -> dict[Hashable, Any]:
        return {}

    def once(self, question: Hashable, answer: Callable[[], Answer]) -> Answer:
        """Return ``answer()``, computed only once for each ``question``."""
        if question not in self._answers:
            value = answer()
            if len(self._answers) == MOST_KEPT:
                return value
            self._answers[question] = value
        return cast(Answer, self._answers[question])

    def decided(self, what: Chosen, names: Iterable[str]) -> bool | None:
        """Return ``what(scene, names, report)``, computed once for each set of names."""
        chosen = frozenset(names)
        return self.once((what, chosen), lambda: what(self.scene, sorted(chosen), self.report))

    @cached_property
    def declared(self) -> DeclaredNames:
        """The names that answers may contain."""
        return DeclaredNames.of(self.scene, self.also)

    @cached_property
    def coordinates(self) -> list[str]:
        """The scene's configuration coordinates, in order."""
        return [c.name for c in coordinate_table(self.scene).coordinates]

    def with_own(self, names: tuple[str, ...], texts: tuple[str, ...]) -> Key:
        """Return the key of the scene with further coordinates ``names``, and equations ``texts`` that define them."""
        return self.once((names, texts), lambda: self._with_own(names, texts))

    def _with_own(self, names: tuple[str, ...], texts: tuple[str, ...]) -> Key:
        """Return a new key for `with_own`."""
        more = tuple(Equation(name=f"own {i + 1}", text=text) for i, text in enumerate(texts))
        update = {
            "coordinates": (*self.scene.coordinates, *names),
            "constraints": (*self.scene.constraints, *more),
            "expect": {},
        }
        return Key(self.scene.model_copy(update=update), self.convention, base=self)

    @cached_property
    def motion(self) -> RightMotion | DofkitError:
        """The equations of motion, or the error for which they are unknown."""
        return right_motion_or_why(self.scene)

    @cached_property
    def whole_motion(self) -> RightMotion | DofkitError:
        """The equations of motion without elimination: every constraint keeps its multiplier; or the error."""
        return right_motion_or_why(self.scene, whole=True)

    @cached_property
    def constraints(self) -> dict[str, ConstraintEntry]:
        """The entries of the report by name."""
        return {entry.name: entry for entry in self.report.constraints}
