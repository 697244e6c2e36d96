"""The house keeps its shape: the top of the package, sizes, names, imports inside functions, and who fails how.

Each rule may have exceptions, with a reason; there are at most ten in all, and the list may only shrink.
"""

from __future__ import annotations

import ast
import re
import tomllib
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple, TypeVar

import pytest
import yaml
from shared.sources import PACKAGE, SOURCES, nodes_of, one_process, tree_of, trees

from dofkit.scene.constraints import TYPES

pytestmark = one_process
Definition = TypeVar("Definition", ast.FunctionDef, ast.ClassDef)

#: The chapters of the book: the rooms, the site and two contracts.
TOP = {
    "base", "expressions", "exact", "scene", "relations", "mobility", "configuration", "integrability",
    "classification", "models", "motion", "methods", "benchmark", "homework", "interface", "checker",
    "pictures", "site", "system.py", "report.py", "__init__.py", "__main__.py", "py.typed", "THEOREMS.md",
}  # fmt: skip

LONGEST_FUNCTION, MOST_PARAMETERS, LONGEST_CLASS, LONGEST_FILE, MOST_METHODS = 40, 6, 200, 400, 20
#: Heavy, optional, or what nothing but this needs: imported where they are used.
LATE_IMPORTS = frozenset(
    {"sympy", "rich", "matplotlib", "PIL", "distributed", "jinja2", "flint", "mujoco", "typst", "latex2mathml",
     "contourpy", "dofkit.base.runs", "dofkit.base.workers", "dofkit.methods.certificates.lowering"}
)  # fmt: skip
#: Where one bad file or answer must not stop the others, whatever it does.
CATCH_ALL = frozenset(
    {"base/worker_process.py", "homework/assignment.py", "homework/grading.py", "interface/answers.py",
     "benchmark/runner.py"}
)  # fmt: skip


class Exemption(NamedTuple):
    """What is let through: ``place`` is ``FILE`` or ``FILE:NAME``."""

    rule: str
    place: str
    reason: str


EXEMPTIONS: tuple[Exemption, ...] = ()
MOST_EXEMPTIONS = 10


def defined(kind: type[Definition]) -> Iterator[tuple[str, Definition]]:
    """(FILE:NAME, definition) of every definition of a kind."""
    return ((f"{name}:{node.name}", node) for name, node in nodes_of(kind))


def without_docstring(node: ast.FunctionDef) -> int:
    """The lines of a function, without decorators and docstring."""
    first = node.body[0]
    told = isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant) and isinstance(first.value.value, str)
    assert node.end_lineno is not None
    return node.end_lineno - node.lineno + 1 - ((first.end_lineno or 0) - first.lineno + 1 if told else 0)


def long_functions() -> Iterator[str]:
    for place, node in defined(ast.FunctionDef):
        if without_docstring(node) > LONGEST_FUNCTION:
            yield place


def many_parameters() -> Iterator[str]:
    for place, node in defined(ast.FunctionDef):
        given = [a.arg for a in (*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs)]
        command = any("command" in ast.unparse(d) for d in node.decorator_list)
        if len([a for a in given if a not in ("self", "cls")]) > MOST_PARAMETERS and not command:
            yield place


def long_classes() -> Iterator[str]:
    for place, node in defined(ast.ClassDef):
        assert node.end_lineno is not None
        if node.end_lineno - node.lineno + 1 > LONGEST_CLASS:
            yield place


def many_methods() -> Iterator[str]:
    for place, node in defined(ast.ClassDef):
        if sum(isinstance(part, ast.FunctionDef) for part in node.body) > MOST_METHODS:
            yield place


def long_files() -> Iterator[str]:
    for name, path in SOURCES.items():
        if len(path.read_text(encoding="utf-8").splitlines()) > LONGEST_FILE:
            yield name


def late_imports() -> Iterator[str]:
    """Imports inside functions; the command line imports what a command or an option needs when it is asked for."""
    for place, node in defined(ast.FunctionDef):
        if place.startswith("interface/"):
            continue
        for part in ast.walk(node):
            if isinstance(part, ast.Import | ast.ImportFrom):
                modules = [part.module or ""] if isinstance(part, ast.ImportFrom) else [a.name for a in part.names]
                if any(LATE_IMPORTS.isdisjoint({module, module.split(".")[0]}) for module in modules):
                    yield place


def repeated_classes() -> Iterator[str]:
    homes: defaultdict[str, list[str]] = defaultdict(list)
    for place, _ in defined(ast.ClassDef):
        file, name = place.split(":")
        homes[name].append(file)
    for name, files in homes.items():
        if len(files) > 1:
            yield from (f"{file}:{name}" for file in files)


def undocumented() -> Iterator[str]:
    """Public functions, methods apart, and classes without a docstring."""
    for name, tree in trees().items():
        if not ast.get_docstring(tree):
            yield name
        for node in tree.body:
            if (
                isinstance(node, ast.FunctionDef | ast.ClassDef)
                and not node.name.startswith("_")
                and not ast.get_docstring(node)
                and "overload" not in map(ast.unparse, node.decorator_list)
            ):
                yield f"{name}:{node.name}"


#: Names of types that are words of another language in these files: what a question asks for, or a word that is
#: counted; JSON Schema, or what people call a string; the chart of the ground; the key of a point on a body.
_OTHER_WORDS = {
    "equation": {
        "homework/questions/equations.py", "homework/starting.py",
    },
    "string": {"scene/fields.py", "homework/key/facts.py", "pictures/placed_shapes.py"},
    "fixed": {"scene/frames.py"},
    "on": {"scene/world.py"},
}  # fmt: skip


def types_as_text() -> Iterator[str]:
    """A constraint type's name as text, or a type compared with anything, where the types are not defined.

    The checker says what each type means a second time, on purpose; models of others are written in these types.
    """
    unused = {(word, name) for word, names in _OTHER_WORDS.items() for name in names}
    elsewhere = ("scene/constraints/", "benchmark/", "checker/", "models/")
    for name, text in nodes_of(ast.Constant):
        if isinstance(text.value, str) and text.value in TYPES and not name.startswith(elsewhere):
            unused.discard((text.value, name))
            if name not in _OTHER_WORDS.get(text.value, ()):
                yield f"{name}:{text.value}"
    for name, comparison in nodes_of(ast.Compare):
        if _compares_a_type(comparison) and not name.startswith(elsewhere):
            yield f"{name}:{ast.unparse(comparison)}"
    yield from (f"{name}:{word} is no longer used there" for word, name in unused)


def _compares_a_type(node: ast.Compare) -> bool:
    """``.type`` or ``.kind()`` beside anything but texts, as the kinds of forces are; a text is looked at by itself."""
    sides = [ast.unparse(side).endswith((".type", ".kind()")) for side in (node.left, *node.comparators)]
    others = [side for side, of_type in zip((node.left, *node.comparators), sides, strict=True) if not of_type]
    leaves = [part for side in others for part in (side.elts if isinstance(side, ast.Tuple) else [side])]
    return any(sides) and not (leaves and all(isinstance(part, ast.Constant) for part in leaves))


def precision_left_set() -> Iterator[str]:
    for name, node in nodes_of(ast.Assign):
        if any(isinstance(target, ast.Attribute) and ast.unparse(target) == "ctx.prec" for target in node.targets):
            yield name


def catch_all() -> Iterator[str]:
    for name, handler in nodes_of(ast.ExceptHandler):
        caught = ast.unparse(handler.type) if handler.type else "BaseException"
        if caught in ("Exception", "BaseException") and name not in CATCH_ALL:
            yield name


def reasons_told_apart() -> Iterator[str]:
    """Outside `exact/` one name is caught where there is no value: FLINT's errors and their kinds are not."""
    for name, node in nodes_of(ast.ImportFrom):
        if (node.module or "").startswith("flint.utils") and not name.startswith("exact/"):
            yield name
    for name, handler in nodes_of(ast.ExceptHandler):
        caught = set(re.findall(r"\w+", ast.unparse(handler.type))) if handler.type else set()
        if caught & {"TooLargeError", "OutsideDomainError"} and not name.startswith("exact/"):
            yield name


def unknown_jobs() -> Iterator[str]:
    """Texts of the form ``dofkit.MODULE:FUNCTION`` that name no function."""
    functions = {place for place, _ in defined(ast.FunctionDef)}
    for name, node in nodes_of(ast.Constant):
        if isinstance(node.value, str) and node.value.startswith("dofkit."):
            module, colon, function = node.value.partition(":")
            file = module.removeprefix("dofkit.").replace(".", "/") + ".py"
            if colon and f"{file}:{function}" not in functions:
                yield f"{name}:{node.value}"


#: Rooms so small, or so clear from the names in them, that a list of modules would say nothing.
UNLISTED: set[str] = set()


def unlisted_modules() -> Iterator[str]:
    """Modules and packages directly in a room that its docstring does not name."""
    for room in sorted(name for name in TOP - UNLISTED if (PACKAGE / name / "__init__.py").exists()):
        text = ast.get_docstring(tree_of(f"{room}/__init__.py")) or ""
        for path in sorted((PACKAGE / room).iterdir()):
            is_module = path.suffix == ".py" or (path / "__init__.py").exists()
            if is_module and not path.stem.startswith("__") and f"`{path.stem}`" not in text:
                yield f"{room}/{path.name}"


RULES = {
    "long function": long_functions,
    "many parameters": many_parameters,
    "long class": long_classes,
    "many methods": many_methods,
    "long file": long_files,
    "late import": late_imports,
    "repeated class name": repeated_classes,
    "undocumented": undocumented,
    "type as text": types_as_text,
    "precision left set": precision_left_set,
    "catch all": catch_all,
    "reasons told apart": reasons_told_apart,
    "unknown job": unknown_jobs,
    "module that the docstring of its room does not name": unlisted_modules,
}


def test_the_top_is_a_table_of_contents() -> None:
    assert {entry.name for entry in PACKAGE.iterdir()} - {"__pycache__", "_catalog"} == TOP


def test_the_layers_that_the_architecture_page_draws_are_those_of_the_import_contract() -> None:
    root = PACKAGE.parent
    contracts = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"][
        "contracts"
    ]
    layers = next(c["layers"] for c in contracts if c["type"] == "layers")
    floors = re.findall(
        r"^ *\d+   ((?:\w+(?:/|\.py) +)+)",
        (PACKAGE / "site" / "pages" / "about" / "architecture.md").read_text(encoding="utf-8"),
        re.MULTILINE,
    )
    drawn = [[name.removesuffix("/").removesuffix(".py") for name in floor.split()] for floor in floors]
    assert drawn == [[name.removeprefix("dofkit.") for name in layer.split(" | ")] for layer in layers]


@pytest.mark.parametrize("rule", RULES)
def test_rule(rule: str) -> None:
    let_through = {e.place for e in EXEMPTIONS if e.rule == rule}
    broken = set(RULES[rule]())
    assert not broken - let_through, "\n".join(["", *sorted(broken - let_through)])
    assert not let_through - broken, f"no longer needed: {sorted(let_through - broken)}"


def test_exceptions_are_few_and_have_reasons() -> None:
    assert len(EXEMPTIONS) <= MOST_EXEMPTIONS
    assert all(e.reason and e.rule in RULES for e in EXEMPTIONS)


def test_every_test_that_is_spread_exists() -> None:
    tests = Path(__file__).parent
    spread = {f"{m}.py": names for m, names in yaml.safe_load((tests / "spread.yaml").read_text()).items()}
    assert [(m, t) for m, names in spread.items() for t in names if f"def {t}(" not in (tests / m).read_text()] == []
