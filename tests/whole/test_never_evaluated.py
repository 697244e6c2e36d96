"""Text is data: nothing in the package hands a text to anything that would evaluate it."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from shared.sources import calls, one_process, trees

pytestmark = one_process
#: Functions that evaluate text, or may.
FORBIDDEN = frozenset(
    {"sympify", "parse_expr", "parse_latex", "parse_mathematica", "eval", "exec", "compile", "lambdify", "S",
     "_sympify", "nsimplify", "literal_eval", "autowrap", "ufuncify", "import_module", "__import__", "system",
     "popen", "unsafe_load", "loads_pickle"}
)  # fmt: skip
#: What takes a text as its name, and reads nothing in it.
NAMED = frozenset({"Symbol", "Dummy", "Function", "symbols", "ReferenceFrame", "Point"})
#: Calls that look alike and are not: by file and the text of the call's function.
ALLOWED = {
    ("base/display.py", "import_module"): "the package's own module that draws, by a fixed name",
    ("base/libraries.py", "import_module"): "numpy and networkx, by a fixed name, when they are first used",
    ("interface/jobs.py", "import_module"): "the package's own module that answers, by a fixed name",
    ("models/mujoco_model.py", "spec.compile"): "MuJoCo's compiler of a model, which runs no text",
    ("models/formats.py", "import_module"): "the reader of a format, by the table of formats",
    ("methods/table.py", "import_module"): "a method's own module, by the name of its row in the table",
    (
        "site/browser/__init__.py",
        "import_module",
    ): "a module of the page's own, which its script names",
    ("base/worker_process.py", "import_module"): "the module of a job's function, which the parent process names",
}


def is_text(node: ast.expr) -> bool:
    """Whether an expression is plainly a text."""
    if isinstance(node, ast.JoinedStr):
        return True
    if isinstance(node, ast.Call):
        return isinstance(node.func, ast.Name) and node.func.id in ("str", "repr")
    return isinstance(node, ast.Constant) and isinstance(node.value, str)


def named(module: ast.Module, modules: frozenset[str]) -> set[str]:
    """Names that a module binds by importing from ``modules``."""
    return {
        alias.asname or alias.name
        for node in ast.walk(module)
        if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] in modules
        for alias in node.names
    }


def test_there_is_something_to_look_at() -> None:
    assert len(trees()) > 20


def may_evaluate(place: str, function: str) -> bool:
    owner, _, name = function.rpartition(".")
    if name not in FORBIDDEN or (place, function) in ALLOWED:
        return False
    return not (name == "compile" and owner == "re") and not (name in ("system", "popen") and owner != "os")


def test_nothing_evaluates_text() -> None:
    assert [f"{place}:{call.lineno}: {name}(...)" for place, name, call in calls() if may_evaluate(place, name)] == []


def test_nothing_evaluating_is_imported() -> None:
    for place, module in trees().items():
        imported = named(module, frozenset({"sympy", "ast", "code", "pickle", "shelve"}))
        assert not imported & (FORBIDDEN | {"sympy.parsing"}), place


def given_a_text() -> Iterator[str]:
    """Calls of sympy's that would make an expression of a text."""
    from_sympy = {place: named(module, frozenset({"sympy"})) - NAMED for place, module in trees().items()}
    for place, function, call in calls():
        owner, _, name = function.rpartition(".")
        sympifies = function in from_sympy[place] or owner in ("sympy", "sp") or (name == "subs")
        if sympifies and name not in NAMED:
            given = [*call.args, *(keyword.value for keyword in call.keywords if keyword.arg is None)]
            if any(map(is_text, given)):
                yield f"{place}:{call.lineno}: {function}"


def test_sympy_is_given_no_text() -> None:
    assert list(given_a_text()) == []
