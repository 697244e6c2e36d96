"""Expressions that are equal up to the names in them: their common shape, and one rewritten with the names of another.

Only names of coordinates (which velocities, accelerations and differentials share) and of parameters that begin with
``_`` (geometry that the scene does not state) are replaced. Names of other parameters and of functions are kept.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property
from typing import Any, NamedTuple, TypeVar, overload

from dofkit.expressions.tree import Expr, children, sym

#: The kinds of symbols that carry the name of a coordinate.
OF_COORDINATES = frozenset({"coordinate", "velocity", "acceleration", "differential"})
#: The kinds by which `coordinates_in` counts a coordinate: its value and its velocity.
VALUED = frozenset({"coordinate", "velocity"})


class Occurring(NamedTuple):
    """The ``kinds`` of symbols in an expression, and the numbers of those names that belong to ``coordinates``."""

    kinds: frozenset[str]
    coordinates: tuple[int, ...]


class ExpressionShape(NamedTuple):
    """An expression without its names.

    ``skeleton``: the expression with its names replaced by numbers in order of first occurrence; ``names``: the
    replaced names in that order; ``kept``: all other names of symbols, sorted.

    >>> from dofkit.expressions.tree import coordinate, velocity
    >>> shape_of(coordinate("y") * velocity("x")).names
    ('y', 'x')
    >>> shape_of(coordinate("y") * velocity("x")).skeleton == shape_of(coordinate("a") * velocity("b")).skeleton
    True
    """

    skeleton: Expr
    names: tuple[str, ...]
    kept: tuple[str, ...]
    occurring: Occurring

    @property
    def name_order(self) -> tuple[int | str, ...]:
        """The numbers of the replaced names, sorted by name, with the kept names among them.

        An algorithm that uses names only for sorting does the same for expressions of equal skeleton and `name_order`.
        """
        places: dict[str, int | str] = {name: name for name in self.kept}
        places.update((name, k) for k, name in enumerate(self.names))
        return tuple(places[name] for name in sorted(places))


def is_name(symbol: Expr) -> bool:
    """Return whether a shape replaces the name of ``symbol``: a coordinate's, or a parameter's beginning with ``_``."""
    kind, name = symbol.args
    return kind in OF_COORDINATES or (kind == "parameter" and name[0] == "_")


def shape_of(e: Expr) -> ExpressionShape:
    """Return the `ExpressionShape` of ``e``, which is computed once and kept in ``e.shape``."""
    shape: ExpressionShape | None = e.shape
    if shape is None:
        places: dict[str, str] = {}
        for symbol in _symbols_in_order(e):
            if is_name(symbol):
                name = symbol.args[1]
                stem = name[:2] if name[0] == "_" else ""
                places.setdefault(name, f"{stem}{len(places)}")
        kept = sorted({s.args[1] for s in e.symbols if not is_name(s)})
        called = {s.args[1] for s in e.symbols if s.args[0] in VALUED}
        occurring = Occurring(kinds_in(e), tuple([k for k, name in enumerate(places) if name in called]))
        shape = e.shape = ExpressionShape(renamed(e, places), tuple(places), tuple(kept), occurring)
    return shape


def kinds_in(e: Expr) -> frozenset[str]:
    """Return the kinds of the symbols that occur in ``e``."""
    return frozenset([s.args[0] for s in e.symbols]) if e.shape is None else e.shape.occurring.kinds


def coordinates_in(e: Expr) -> frozenset[str]:
    """Return the names of the coordinates that occur in ``e``, as themselves or as velocities.

    >>> from dofkit.expressions.tree import coordinate, velocity
    >>> sorted(coordinates_in(coordinate("y") * velocity("x")))
    ['x', 'y']
    """
    shape = e.shape
    if shape is None:
        return frozenset([s.args[1] for s in e.symbols if s.args[0] in VALUED])
    names = shape.names
    return frozenset([names[k] for k in shape.occurring.coordinates])


def _symbols_in_order(e: Expr) -> list[Expr]:
    """Return the symbols of ``e`` in order of first occurrence."""
    symbols: dict[Expr, None] = {}
    stack, seen = [e], set[int]()
    while stack:
        node = stack.pop()
        if node.op == "sym":
            symbols.setdefault(node)
        elif id(node) not in seen:
            seen.add(id(node))
            stack.extend(reversed(children(node)))
    return list(symbols)


def renamed(e: Expr, names: Mapping[str, str]) -> Expr:
    """Return ``e`` with its names replaced by the one-to-one map ``names``; nothing is simplified anew.

    >>> from dofkit.expressions.tree import coordinate
    >>> renamed(coordinate("x") + 1, {"x": "y"}) == coordinate("y") + 1
    True
    """
    return Renaming(names).of(e)


class Renaming:
    """Rewrites expressions by a one-to-one map of names, each node once."""

    def __init__(self, names: Mapping[str, str]) -> None:
        self.names = names
        self._renamed: dict[Expr, Expr] = {}

    def of(self, e: Expr) -> Expr:
        """Return ``e`` in the new names, with its shape and functions if those of ``e`` are known."""
        earlier = self._renamed.get(e)
        if earlier is not None:
            return earlier
        op, args = e.op, e.args
        if op == "num" or op == "const":
            return e
        if op == "sym":
            other = self.names.get(args[1])
            renamed_expression = e if other is None else sym(args[0], other)
        else:
            renamed: tuple[Any, ...]
            if op == "fn":
                renamed = (args[0], *map(self.of, args[1:]))
            elif op == "call":
                renamed = (args[0], args[1], tuple(map(self.of, args[2])))
            else:
                renamed = tuple(map(self.of, args))
            renamed_expression = Expr(op, renamed)
            renamed_expression._functions = e._functions
            if e.shape is not None:
                skeleton, names, kept, occurring = e.shape
                names = tuple([self.names.get(n, n) for n in names])
                renamed_expression.shape = ExpressionShape(skeleton, names, kept, occurring)
        self._renamed[e] = renamed_expression
        return renamed_expression


T = TypeVar("T")


class Unwritten(Sequence[T]):
    """A lazy sequence of ``number`` objects with expressions, made by ``write`` when an element is first needed.

    The objects are connected by common coordinates; ``mentioned`` are all of these; no number has more than ``longest``
    bits. The sequence equals the tuple of its elements, and is pickled as that tuple.
    """

    def __init__(self, number: int, mentioned: frozenset[str], longest: int, write: Callable[[], Iterable[T]]) -> None:
        self.number, self.mentioned, self.longest, self._write = number, mentioned, longest, write

    @cached_property
    def written(self) -> tuple[T, ...]:
        """The elements."""
        return tuple(self._write())

    def __len__(self) -> int:
        return self.number

    @overload
    def __getitem__(self, index: int) -> T: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[T]: ...
    def __getitem__(self, index: int | slice) -> T | Sequence[T]:
        return self.written[index]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Sequence) and self.written == tuple(other)

    def __hash__(self) -> int:
        return hash(self.written)

    def __reduce__(self) -> tuple[type[tuple[T, ...]], tuple[tuple[T, ...]]]:
        return tuple, (self.written,)
