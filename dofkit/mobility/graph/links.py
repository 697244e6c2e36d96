"""Links as people give them: pairs of hashable joints, an array of integers with two columns, or a networkx graph."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import chain
from typing import Any, NamedTuple

from dofkit.base.errors import DofkitError
from dofkit.base.libraries import np

#: Any hashable name.
Joint = Any
Link = tuple[Any, Any]

#: Whole numbers are joints' names that stand in a table of at most so many places for each end of a link.
SPREAD = 4
#: Beyond this a whole number is a name like any other.
FAR = 2**62
#: Links of a list that are read in one go.
NEAR = 4096


class LinkageError(DofkitError):
    """A list of links that is none: a link from a joint to itself, or no pair; or a dimension beyond 1, 2, 3."""


class Graph(NamedTuple):
    """Joints in the order in which they first occur, links as given, and the numbers of their joints in turn.

    ``joints``: names, or an array of integers; ``links``: tuples, or an array with two columns; ``ends``: a list or an
    array of integers.
    """

    joints: Any
    links: Any
    ends: Any

    def all_joints(self) -> tuple[Joint, ...]:
        """The joints by their names."""
        return tuple(self.joints.tolist() if isinstance(self.joints, np.ndarray) else self.joints)

    def links_at(self, places: Sequence[int]) -> list[Link]:
        """Some of the links, as tuples."""
        if isinstance(self.links, np.ndarray):
            return list(map(tuple, self.links[np.asarray(places, dtype=np.intp)].tolist()))
        return [self.links[i] for i in places]

    def all_links(self) -> tuple[Link, ...]:
        """The links as tuples."""
        return tuple(zip(*self.links.T.tolist(), strict=True) if isinstance(self.links, np.ndarray) else self.links)


def read(links: Iterable[Link] | Any, joints: Iterable[Joint] = ()) -> Graph:
    """Joints and links numbered. Raises LinkageError that names the first link that is none."""
    given = _pairs(links)
    named = list(chain(getattr(links, "nodes", ()), joints))
    found = _numbered_array(given) if not named else None
    graph = found or _numbered(list(map(tuple, given.tolist())) if isinstance(given, np.ndarray) else given, named)
    loops = np.flatnonzero(np.equal(graph.ends[::2], graph.ends[1::2]))
    if len(loops):
        joint = graph.all_joints()[graph.ends[2 * int(loops[0])]]
        raise LinkageError(f"link number {loops[0] + 1} joins {joint!r} to itself")
    return graph


def _pairs(links: Iterable[Link] | Any) -> Any:
    """The links as a list of tuples, or as an array of integers with two columns."""
    if hasattr(links, "nodes") and hasattr(links, "edges"):
        return [(a, b) for a, b, *_ in links.edges()]
    if isinstance(links, np.ndarray):
        if links.ndim == 2 and links.shape[1] == 2 and np.issubdtype(links.dtype, np.integer):
            return links
        links = links.tolist()
    try:
        given: Sequence[Any] = list(links)
    except TypeError as error:
        raise LinkageError(f"links are a list of pairs or a graph, not {links!r}") from error
    kinds = set(map(type, given))
    if not kinds <= {tuple, list} or not set(map(len, given)) <= {2}:
        for place, link in enumerate(given):
            if not isinstance(link, tuple | list) or len(link) != 2:
                raise LinkageError(f"link number {place + 1} is {link!r}; a link is a pair of joints")
    return given if kinds <= {tuple} else [tuple(link) for link in given]


def _numbered(given: Sequence[Link], named: Iterable[Joint]) -> Graph:
    """Joints of any kind."""
    flat = list(chain.from_iterable(given))
    try:
        number = {v: i for i, v in enumerate(dict.fromkeys(chain(named, flat)))}
    except TypeError as error:
        raise LinkageError(f"joints need distinct names: {error}") from error
    return Graph(list(number), given, list(map(number.__getitem__, flat)))


def _numbered_array(given: Any) -> Graph | None:
    """Joints that are whole numbers of a narrow range; None where they are not."""
    flat = given.ravel() if isinstance(given, np.ndarray) else _whole_numbers(given)
    if flat is None or not len(flat):
        return None
    low, high = int(flat.min()), int(flat.max())
    span = high - low + 1
    if span > SPREAD * len(flat) or not -FAR < low <= high < FAR:
        return None
    places = flat.astype(np.int64, copy=False)
    if low:
        places = places - low
    first = np.full(span, len(flat), dtype=np.int32)
    first[places[::-1]] = np.arange(len(flat) - 1, -1, -1, dtype=np.int32)
    order = np.sort(first[first < len(flat)])
    number = np.empty(span, dtype=np.int32)
    number[places[order]] = np.arange(len(order), dtype=np.int32)
    return Graph(flat[order], given, number[places])


def _whole_numbers(given: Sequence[Link]) -> Any:
    """The joints of all links in turn as an array, some links after others; None where one is no integer or too large.

    What was just read of a part is still near when it is read again.
    """
    flat = np.empty(2 * len(given), np.int64)
    for place in range(0, len(given), NEAR):
        names = list(chain.from_iterable(given[place : place + NEAR]))
        if not set(map(type, names)) <= {int}:
            return None
        try:
            flat[2 * place : 2 * place + len(names)] = np.fromiter(names, np.int64, len(names))
        except OverflowError:
            return None
    return flat
