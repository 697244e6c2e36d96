"""The families of stress trials: one function each, in one module a theme."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from dofkit.chart.families import (
    blocks,
    catalog,
    chains,
    equivalence,
    forms,
    graphs,
    identities,
    joints,
    near,
    powers,
    relations,
    times,
)
from dofkit.chart.trial import Trial

#: Every family by name. ``quick``: a few small members that stand for the others.
FAMILIES: Mapping[str, Callable[[bool], Iterator[Trial]]] = {
    **catalog.FAMILIES,
    **graphs.FAMILIES,
    **joints.FAMILIES,
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
