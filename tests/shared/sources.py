"""The source files of the package and their syntax trees, parsed once in a process.

The modules that read them are one group for xdist, so that one process parses for all: ``pytestmark = one_process``.
"""

from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import TypeVar

import pytest

import dofkit

PACKAGE = Path(dofkit.__file__).parent
#: Every source file, by its path in the package.
SOURCES = {path.relative_to(PACKAGE).as_posix(): path for path in sorted(PACKAGE.rglob("*.py"))}
Node = TypeVar("Node", bound=ast.AST)
one_process = pytest.mark.xdist_group("sources")


@cache
def tree_of(name: str) -> ast.Module:
    """Return the syntax tree of a source file, by its path in the package."""
    return ast.parse(SOURCES[name].read_text(encoding="utf-8"))


def tree_at(path: Path) -> ast.Module:
    """Return the syntax tree of a source file, by its path."""
    return tree_of(path.relative_to(PACKAGE).as_posix())


def trees() -> dict[str, ast.Module]:
    """Return all syntax trees, by file."""
    return {name: tree_of(name) for name in SOURCES}


@cache
def _by_kind() -> Mapping[type[ast.AST], Sequence[tuple[str, ast.AST]]]:
    nodes = defaultdict[type[ast.AST], list[tuple[str, ast.AST]]](list)
    for name, tree in trees().items():
        for node in ast.walk(tree):
            if not isinstance(node, ast.expr_context):
                nodes[type(node)].append((name, node))
    return nodes


def nodes_of(kind: type[Node]) -> Iterator[tuple[str, Node]]:
    """Yield (file, node) for every node of one kind in the package."""
    for name, node in _by_kind().get(kind, ()):
        assert isinstance(node, kind)
        yield name, node


@cache
def calls() -> Sequence[tuple[str, str, ast.Call]]:
    """Return (file, function as written, call) for every call in the package."""
    return [(name, ast.unparse(node.func), node) for name, node in nodes_of(ast.Call)]
