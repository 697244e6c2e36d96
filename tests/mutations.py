"""Which tests notice a wrong line: lines of the deciding rooms are changed one at a time, and the tests are run.

python tests/mutations.py [--many 100] [--seed 1] [--workers 2] [--only 3,17] [--list] [options of pytest]

A line is drawn from those that decide: with a comparison, a boolean operator, a sign, 0 or 1, a truth value, the end of
a range. The tests are collected once and run once with a probe at each of these lines. Then each change is made in a
fork of that process, in memory, and the tests that run the line are run there until one fails: the catalog's scenes
first, then the quickest. A change that makes a test run much longer, or take much more memory, is noticed too.
Processes that a test starts run the files as they stand. What is not noticed and changes no answer stands in `SAME`,
with why; so does a named limit of the work, or of rounding, that is another by one.
"""

from __future__ import annotations

import argparse
import ast
import builtins
import functools
import gc
import json
import os
import random
import re
import resource
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from types import CodeType, FunctionType

import pytest

ROOT = Path(__file__).parents[1]
#: What decides.
ROOMS = ("exact", "relations", "mobility", "configuration", "integrability", "classification", "scene/lowering.py")
#: The scenes against what they expect.
SCENES = "tests/whole/test_catalog.py"
#: A test may take so many seconds of processor time, and so many times what it took; and bytes of memory.
SECONDS, LONGER, MEMORY = 20, 10, 8 << 30
#: What is called at the lines that are looked at.
PROBE = "_line_is_run"
COMPARED: Mapping[type[ast.cmpop], tuple[str, str]] = {
    ast.Lt: ("<", "<="),
    ast.LtE: ("<=", "<"),
    ast.Gt: (">", ">="),
    ast.GtE: (">=", ">"),
    ast.Eq: ("==", "!="),
    ast.NotEq: ("!=", "=="),
    ast.Is: ("is", "is not"),
    ast.IsNot: ("is not", "is"),
    ast.In: ("in", "not in"),
    ast.NotIn: ("not in", "in"),
}
JOINED: Mapping[type[ast.AST], tuple[str, str]] = {
    ast.And: ("and", "or"),
    ast.Or: ("or", "and"),
    ast.Add: ("+", "-"),
    ast.Sub: ("-", "+"),
}
#: The file, the line as it is and as it is changed: why no answer is another one.
SAME: Mapping[tuple[str, str, str], str] = {
    (
        "dofkit/relations/normal/polynomial_zeros.py",
        "extremes = [(f, -1 if (weight > 0) == (constant > 0) else 1) for f, weight in weights.items()]",
        "extremes = [(f, -1 if (weight > 0) == (constant >= 0) else 1) for f, weight in weights.items()]",
    ): "the constant is not 0: its absolute value is a sum of weights that are not",
    (
        "dofkit/configuration/local/manifold.py",
        "for k in range(1, order if self.rows else 1):",
        "for k in range(1, order if self.rows else 0):",
    ): "both ranges are empty",
    (
        "dofkit/configuration/local/manifold.py",
        "zero, unity = self.sample, self.sample + 1",
        "zero, unity = self.sample, self.sample - 1",
    ): "a quadratic form has the same value at -u as at u",
    (
        "dofkit/integrability/lie_algebra.py",
        "enough = n - free + 2 + (BEYOND if special else 0)",
        "enough = n - free + 2 + (BEYOND if special else 1)",
    ): "an order higher than is enough",
    (
        "dofkit/integrability/pfaffian_system.py",
        "return None, False",
        "return None, True",
    ): "nothing asks how sure a number is that is not known",
    (
        "dofkit/exact/matrices/rational.py",
        "while 2 * b * b > p:",
        "while 2 * b * b >= p:",
    ): "a prime that is not 2 is no even number",
    (
        "dofkit/configuration/measured/equations.py",
        "if np.all(spectrum > self.noise) or np.all(spectrum < -self.noise):",
        "if np.all(spectrum >= self.noise) or np.all(spectrum < -self.noise):",
    ): "a floating point number meets no other exactly",
    (
        "dofkit/exact/ring/canonical.py",
        "if len(poly) > MAX_TERMS:",
        "if len(poly) >= MAX_TERMS:",
    ): "a bound on the work that is done",
}


@dataclass(frozen=True)
class Mutant:
    """A file of the repository, a line counted from 1, and its text before and after."""

    path: str
    line: int
    before: str
    after: str

    def __str__(self) -> str:
        return f"{self.path}:{self.line}: {self.before.strip()}  ->  {self.after.strip()}"


#: A name in capitals, and a floating point number, which no other meets exactly.
LIMIT = re.compile(r"\b(?!ZERO|TIME|CONIC)(?<!\.)[A-Z][A-Z_]{3,}\b|\d\.\d|\de-?\d")


def shifts_a_bound(mutant: Mutant) -> bool:
    """Return whether only a limit with a name in capitals is another by one: no answer is promised at it."""
    before, after = mutant.before, mutant.after
    place = next(i for i, (a, b) in enumerate(zip(before, after, strict=False)) if a != b)
    shorter = after[place:].startswith(" - 1") and re.search(r"\brange\(.*\b[A-Z_]{4,}$", before[:place])
    ordered = {before[place], after[place]} == {"=", " "} and before[place - 1] in "<>"
    left, right = re.split(" (?:if|and|or) ", before[:place])[-1], re.split(" (?:if|and|or|else) ", before[place:])[0]
    sides = re.search(r"[^<>=,(]*.$", left), re.match(r"=?[^<>=:,]*", right)
    return bool(shorter or (ordered and any(side and LIMIT.search(side[0]) for side in sides)))


# -- what may be changed ---------------------------------------------------------------------------


def mutants(path: Path) -> Iterator[Mutant]:
    """Every change of one place in a file."""
    text = path.read_text(encoding="utf-8")
    lines = text.splitlines()
    for line, start, end, new in _edits(ast.parse(text), lines):
        old = lines[line - 1].encode()
        after = (old[:start] + new.encode() + old[end:]).decode()
        yield Mutant(path.relative_to(ROOT).as_posix(), line, lines[line - 1], after)


#: A line, from which byte to which, and what is written there instead.
Edit = tuple[int, int, int, str]


def _edits(tree: ast.Module, lines: Sequence[str]) -> Iterator[Edit]:
    for node in _deciding(tree):
        if isinstance(node, ast.Compare):
            operands = [node.left, *node.comparators]
            for left, op, right in zip(operands, node.ops, operands[1:], strict=False):
                yield from _between(left, right, *COMPARED[type(op)], lines)
        elif isinstance(node, ast.BoolOp):
            yield from _between(node.values[0], node.values[1], *JOINED[type(node.op)], lines)
        elif isinstance(node, ast.BinOp) and type(node.op) in JOINED:
            yield from _between(node.left, node.right, *JOINED[type(node.op)], lines)
        elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not | ast.USub):
            sign = lines[node.lineno - 1].encode()[node.col_offset : node.operand.col_offset]
            if node.lineno == node.operand.lineno and b"(" not in sign:
                yield node.lineno, node.col_offset, node.operand.col_offset, ""
        elif isinstance(node, ast.Constant):
            yield from _constant(node)
        elif isinstance(node, ast.Call) and ast.unparse(node.func) == "range" and node.args:
            last = node.args[-1] if len(node.args) < 3 else node.args[1]
            if last.end_lineno is not None and last.end_col_offset is not None:
                yield last.end_lineno, last.end_col_offset, last.end_col_offset, " - 1"


def _deciding(tree: ast.AST) -> Iterator[ast.AST]:
    """The expressions of the functions' bodies; nothing in a text, an annotation, a default, a raise, or a check."""
    for function in ast.walk(tree):
        if isinstance(function, ast.FunctionDef):
            for statement in function.body:
                yield from _within(statement)


def _within(node: ast.AST) -> Iterator[ast.AST]:
    if isinstance(node, ast.JoinedStr | ast.Raise | ast.FunctionDef | ast.ClassDef | ast.Import | ast.ImportFrom):
        return
    if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
        return
    if isinstance(node, ast.keyword) and node.arg == "strict":
        return
    yield node
    for name, value in ast.iter_fields(node):
        if name not in ("annotation", "decorator_list"):
            for child in value if isinstance(value, list) else [value]:
                if isinstance(child, ast.AST):
                    yield from _within(child)


def _between(left: ast.expr, right: ast.expr, old: str, new: str, lines: Sequence[str]) -> Iterator[Edit]:
    """The operator between two operands of one line."""
    if left.end_lineno == right.lineno and left.end_col_offset is not None:
        segment = lines[right.lineno - 1].encode()[left.end_col_offset : right.col_offset].decode()
        pattern = re.escape(old).replace(r"\ ", r"\s+")
        found = re.search(rf"(?<![<>=!\w]){pattern}(?![<>=\w])", segment)
        if found:
            yield right.lineno, left.end_col_offset + found.start(), left.end_col_offset + found.end(), new


def _constant(node: ast.Constant) -> Iterator[Edit]:
    new = {"0": "1", "1": "0", "True": "False", "False": "True"}.get(repr(node.value))
    if new is not None and node.end_col_offset is not None:
        yield node.lineno, node.col_offset, node.end_col_offset, new


def drawn(many: int, seed: int, rooms: Sequence[str] = ROOMS) -> list[Mutant]:
    """So many lines of the rooms, each changed in one place."""
    lines: dict[tuple[str, int], list[Mutant]] = {}
    for room in rooms:
        place = ROOT / "dofkit" / room
        for path in [place] if place.is_file() else sorted(place.rglob("*.py")):
            for mutant in mutants(path):
                lines.setdefault((mutant.path, mutant.line), []).append(mutant)
    rng = random.Random(seed)
    return [rng.choice(lines[key]) for key in rng.sample(sorted(lines), many)]


# -- which tests run a line ------------------------------------------------------------------------


def replaced(path: str, code: CodeType) -> None:
    """Give every function of a file, wherever it is referred to, its body in another version of that file."""
    file = str(ROOT / path)
    import_module(path.removesuffix(".py").removesuffix("/__init__").replace("/", "."))
    bodies = {(body.co_qualname, body.co_firstlineno): body for body in _bodies(code)}
    for function in gc.get_objects():
        if isinstance(function, FunctionType) and function.__code__.co_filename == file:
            function.__code__ = bodies[function.__code__.co_qualname, function.__code__.co_firstlineno]


def _bodies(code: CodeType) -> Iterator[CodeType]:
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield constant
            yield from _bodies(constant)


def probed(path: str, lines: Mapping[int, int]) -> CodeType:
    """Return a file in which the statement around each line, by its mutant's number, first calls the probe."""
    tree = ast.parse((ROOT / path).read_text(encoding="utf-8"))
    for number, line in lines.items():
        body, index = _statement(tree, line)
        call = ast.parse(f"{PROBE}({number})").body[0]
        body.insert(index, ast.fix_missing_locations(ast.copy_location(call, body[index])))
    return compile(tree, str(ROOT / path), "exec")


def _statement(tree: ast.AST, line: int) -> tuple[list[ast.stmt], int]:
    """Return the innermost statement around a line: a body, and where in it the statement stands."""
    around = [
        (statement.end_lineno - statement.lineno, body, index)
        for node in ast.walk(tree)
        for body in vars(node).values()
        if isinstance(body, list)
        for index, statement in enumerate(body)
        if isinstance(statement, ast.stmt) and statement.lineno <= line <= (statement.end_lineno or 0)
    ]
    return min(around, key=lambda entry: entry[0])[1:]


# -- who notices it --------------------------------------------------------------------------------


class Trial:
    """A pytest plugin: in place of one run of the tests, a run for each mutant, each in a fork of this process."""

    def __init__(self, mutants: Mapping[int, Mutant], workers: int, folder: Path) -> None:
        self._mutants, self._workers, self._folder = mutants, workers, folder
        self._failed = ""
        self.outcomes: Counter[str] = Counter()

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.failed:
            self._failed = self._failed or report.nodeid

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        gc.unfreeze()
        tests = {item.nodeid: item for item in session.items}
        os.waitpid(self._fork("probes", functools.partial(self._measured, tests)), 0)
        seconds: dict[str, dict[str, float]] = json.loads((self._folder / "probes").read_text(encoding="utf-8"))
        running: dict[int, int] = {}
        for number, mutant in self._mutants.items():
            if len(running) == self._workers:
                self._end(running)
            covering = seconds.get(str(number), {})
            order = sorted(covering, key=lambda test: (not test.startswith(SCENES), covering[test]))
            chosen = {tests[test]: covering[test] for test in order}
            running[self._fork(str(number), functools.partial(self._judged, mutant, chosen))] = number
        while running:
            self._end(running)
        return True

    def _fork(self, name: str, work: Callable[[], str]) -> int:
        """Return a new process, which writes to a file of this name what the work returns."""
        sys.stdout.flush()
        process = os.fork()
        if process:
            return process
        try:
            os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
            (self._folder / name).write_text(work(), encoding="utf-8")
            os._exit(0)
        finally:
            os._exit(1)

    def _end(self, running: dict[int, int]) -> None:
        """Wait for one of the processes, and print what noticed its mutant."""
        process, status = os.wait()
        number = running.pop(process)
        mutant = self._mutants[number]
        by = (self._folder / str(number)).read_text(encoding="utf-8") if status == 0 else "no end, no memory, no import"
        why_same = SAME.get((mutant.path, mutant.before.strip(), mutant.after.strip()), "")
        why_same = "a limit" if shifts_a_bound(mutant) else why_same
        outcome = "noticed" if by else "same" if why_same else "UNNOTICED"
        self.outcomes[outcome] += 1
        print(f"{number:>3}  {outcome:<9} {mutant}\n     {by or why_same}", flush=True)

    def _measured(self, tests: Mapping[str, pytest.Item]) -> str:
        """Return the tests that run each line and pass, with the seconds of processor time that they take."""
        hits: set[int] = set()
        setattr(builtins, PROBE, hits.add)
        for path in {mutant.path for mutant in self._mutants.values()}:
            replaced(path, probed(path, {n: m.line for n, m in self._mutants.items() if m.path == path}))
        seconds: dict[int, dict[str, float]] = {}
        caches = [f for f in gc.get_objects() if isinstance(f, functools._lru_cache_wrapper)]
        for test, item in tests.items():
            for cached in caches:  # a report that a test before it has worked out counts for this one too
                cached.cache_clear()
            hits.clear()
            self._failed = ""
            start = time.process_time()
            item.config.hook.pytest_runtest_protocol(item=item, nextitem=None)
            for number in hits if not self._failed else ():
                seconds.setdefault(number, {})[test] = time.process_time() - start
        return json.dumps(seconds)

    def _judged(self, mutant: Mutant, tests: Mapping[pytest.Item, float]) -> str:
        """Return the first of the tests that fails; nothing where all pass."""
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        lines = (ROOT / mutant.path).read_text(encoding="utf-8").splitlines()
        lines[mutant.line - 1] = mutant.after
        replaced(mutant.path, compile("\n".join(lines), str(ROOT / mutant.path), "exec"))
        for item, seconds in tests.items():
            allowed = int(time.process_time() + SECONDS + LONGER * seconds)
            resource.setrlimit(resource.RLIMIT_CPU, (allowed, resource.RLIM_INFINITY))
            item.config.hook.pytest_runtest_protocol(item=item, nextitem=None)
            if self._failed:
                break
        return self._failed


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--many", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--only", type=lambda text: [int(number) for number in text.split(",")])
    parser.add_argument("--list", action="store_true", help="only show what would be changed")
    given, options = parser.parse_known_args()
    chosen = dict(enumerate(drawn(given.many, given.seed)))
    chosen = {number: chosen[number] for number in given.only or chosen}
    if given.list:
        print(*(f"{number:>3}  {mutant}" for number, mutant in chosen.items()), sep="\n")
        return
    with tempfile.TemporaryDirectory() as folder:
        trial = Trial(chosen, given.workers, Path(folder))
        pytest.main(["-n0", "-s", "-p", "no:cacheprovider", "--tb=no", "--timeout=3000", *options], plugins=[trial])
    print(", ".join(f"{count} {outcome}" for outcome, count in trial.outcomes.items()))


if __name__ == "__main__":
    main()
