"""Expressions that are the same up to names: what is left without these, and the same in other names.

Names are those of coordinates (their velocities, accelerations and differentials have them too) and of geometry that
was left out, whose parameters begin with ``_``. All other names are kept: parameters and functions are shared.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property
from typing import Any, NamedTuple, TypeVar, overload

from dofkit.expressions.tree import Expr, children, sym

#: The kinds of symbols that are called by a coordinate.
MOVING = frozenset({"coordinate", "velocity", "acceleration", "differential"})
#: Of them those of a coordinate's own value and rate.
VALUED = frozenset({"coordinate", "velocity"})


class Occurring(NamedTuple):
    """The ``kinds`` of symbols in an expression, and which of its names are those of ``coordinates``, by number."""

    kinds: frozenset[str]
    coordinates: tuple[int, ...]


class ExpressionShape(NamedTuple):
    """An expression without its names.

    ``skeleton``: the expression with its names replaced by numbers, in the order in which they first occur; ``names``:
    these, in that order; ``kept``: the names of symbols that are no such names, sorted; ``occurring``: stated by the
    skeleton.

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
        """The numbers of the names in alphabetical order of the names, kept names standing for themselves.

        Of expressions with one skeleton and one order, whatever looks at names only to sort them makes the same.
        """
        places: dict[str, int | str] = {name: name for name in self.kept}
        places.update((name, k) for k, name in enumerate(self.names))
        return tuple(places[name] for name in sorted(places))


def is_name(symbol: Expr) -> bool:
    """Return whether a symbol has a name that may be another: of a coordinate, or of geometry left out."""
    kind, name = symbol.args
    return kind in MOVING or (kind == "parameter" and name[0] == "_")


def shape_of(e: Expr) -> ExpressionShape:
    """Return an expression without its names; worked out once."""
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
    """Return the kinds of the symbols that occur."""
    return frozenset([s.args[0] for s in e.symbols]) if e.shape is None else e.shape.occurring.kinds


def coordinates_in(e: Expr) -> frozenset[str]:
    """Return the coordinates of which the value or the velocity occurs.

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
    """Return the symbols, each where it first occurs."""
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
    """Return an expression in other names, which have to be as many: nothing is folded again.

    >>> from dofkit.expressions.tree import coordinate
    >>> renamed(coordinate("x") + 1, {"x": "y"}) == coordinate("y") + 1
    True
    """
    return Renaming(names).of(e)


class Renaming:
    """Expressions rewritten in other names, one for one."""

    def __init__(self, names: Mapping[str, str]) -> None:
        self.names = names
        self._symbols: dict[Expr, Expr] = {}
        self._renamed: dict[int, tuple[Expr, Expr]] = {}

    def of(self, e: Expr) -> Expr:
        """Return an expression in the other names; its shape is known where it was."""
        op, args = e.op, e.args
        if op == "sym":
            return self._symbol(e)
        if op == "num" or op == "const":
            return e
        earlier = self._renamed.get(id(e))
        if earlier is not None:
            return earlier[1]
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
            renamed_expression.shape = e.shape._replace(names=tuple(self.names.get(n, n) for n in e.shape.names))
        self._renamed[id(e)] = e, renamed_expression
        return renamed_expression

    def _symbol(self, symbol: Expr) -> Expr:
        renamed_symbol = self._symbols.get(symbol)
        if renamed_symbol is None:
            kind, name = symbol.args
            other = self.names.get(name)
            renamed_symbol = self._symbols[symbol] = symbol if other is None else sym(kind, other)
        return renamed_symbol


T = TypeVar("T")


class Unwritten(Sequence[T]):
    """``number`` of things that hold expressions, of which no two parts mention coordinates that are all different.

    ``mentioned``: the coordinates that they mention; ``longest``: no number in them has more bits; ``write`` makes
    them. It is equal to the sequence that it stands for, and a tuple in another process.
    """

    def __init__(self, number: int, mentioned: frozenset[str], longest: int, write: Callable[[], Iterable[T]]) -> None:
        self.number, self.mentioned, self.longest, self._write = number, mentioned, longest, write

    @cached_property
    def written(self) -> tuple[T, ...]:
        """All of them."""
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
