"""The families of stress trials: one function each, in one module a theme."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from dofkit.benchmark.trials import (
    blocks,
    catalog,
    chains,
    equivalence,
    forms,
    graphs,
    identities,
    joints,
    powers,
    relations,
    times,
)
from dofkit.benchmark.trials import (
    mechanisms as anywhere,
)
from dofkit.benchmark.trials import (
    near_singular as near,
)
from dofkit.benchmark.trials.making import few
from dofkit.benchmark.trials.trial import Trial

Family = Callable[[bool], Iterator[Trial]]


def _bounded(family: Family) -> Family:
    """Of the small members, a few that stand for the others."""
    return lambda quick: few(family(True)) if quick else family(False)


_ALL: Mapping[str, Family] = {
    **catalog.FAMILIES,
    **graphs.FAMILIES,
    **joints.FAMILIES,
    **anywhere.FAMILIES,
    **near.FAMILIES,
    **chains.FAMILIES,
    **blocks.FAMILIES,
    **forms.FAMILIES,
    **times.FAMILIES,
    **relations.FAMILIES,
    **powers.FAMILIES,
    **identities.FAMILIES,
    **equivalence.FAMILIES,
}
#: Every family by name. ``quick``: a few small members that stand for the others.
FAMILIES: Mapping[str, Family] = {name: _bounded(family) for name, family in _ALL.items()}
