"""Which tests notice a wrong line: lines of the deciding rooms are changed one at a time, and the tests are run.

python tests/mutations.py --measure FILE          which tests run which line, by coverage.py: once, some 20 minutes
python tests/mutations.py [--map FILE] [--many 100] [--seed 1] [--workers 2] [--only 3,17] [--list]

A line is drawn from those that decide: with a comparison, a boolean operator, a sign, 0 or 1, a truth value, the end of
a range. Each change is made in a copy of the repository, one copy a worker. There, in order and
until one fails: the scenes of the catalog and of the tests against what they expect; the other tests of the default
run, those of the changed room first; the sweeps. A change that makes the tests run without end, or take much more
memory, is noticed too. With a map only the tests that run the line are asked, sweeps included: the others cannot
notice. What is not noticed and changes no answer stands in `SAME`, with why.
"""

from __future__ import annotations

import argparse
import ast
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial
from itertools import count
from pathlib import Path
from queue import SimpleQueue
from typing import Any

from coverage import CoverageData

if sys.platform != "win32":
    import resource

ROOT = Path(__file__).parents[1]
#: What decides.
ROOMS = ("exact", "relations", "mobility", "configuration", "integrability", "classification", "scene/lowering.py")
COPIED = ("dofkit", "tests", "catalog", "README.md", "pyproject.toml", ".ci", "LICENSE")
#: The scenes against what they expect; the rest of the default run; what is left out there.
SCENES = ("tests/whole/test_catalog.py",)
STAGES = ("scenes", "tests", "sweeps")
#: Seconds of processor time for each stage, and bytes of memory.
SECONDS, MEMORY = (300, 3000, 6000), 8 << 30
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
        "dofkit/classification/dependence/equivalence.py",
        "new = [g for g, sound in zip(_finite(self._answer), self._sound, strict=True) if not sound]",
        "new = [g for g, sound in zip(_finite(self._answer), self._sound, strict=False) if not sound]",
    ): "the two are of one length",
    (
        "dofkit/configuration/measured/continuation.py",
        "if stages[-1].residual > VIOLATED * 10 * tolerance:",
        "if stages[-1].residual >= VIOLATED * 10 * tolerance:",
    ): "a floating point number does not meet a bound exactly",
    (
        "dofkit/configuration/local/neighbourhood.py",
        "if largest(change) < 1e-12:",
        "if largest(change) <= 1e-12:",
    ): "a floating point number does not meet a bound exactly",
    (
        "dofkit/relations/normal/polynomial_zeros.py",
        "return [(index, -1 if (weight > 0) == (constant > 0) else 1) for index, weight in weights.items()]",
        "return [(index, -1 if (weight > 0) == (constant >= 0) else 1) for index, weight in weights.items()]",
    ): "the constant is not 0: its absolute value is a sum of weights that are not",
    (
        "dofkit/relations/normal/semidefinite.py",
        "linear.append(ex.add(*(ex.mul(ex.num(fraction(v)), s) for v, s in zip(entries, generators, strict=True))))",
        "linear.append(ex.add(*(ex.mul(ex.num(fraction(v)), s) for v, s in zip(entries, generators, strict=False))))",
    ): "the two are of one length",
}


@dataclass(frozen=True)
class Mutant:
    """A file of the repository, a line counted from 1, and its text before and after."""

    path: str
    line: int
    before: str
    after: str

    @property
    def room(self) -> str:
        return self.path.split("/")[1]

    @property
    def why_same(self) -> str | None:
        return SAME.get((self.path, self.before.strip(), self.after.strip()))

    def __str__(self) -> str:
        return f"{self.path}:{self.line}: {self.before.strip()}  ->  {self.after.strip()}"


@dataclass(frozen=True)
class Verdict:
    """The stage that noticed a mutant (None where none did), and by what."""

    stage: str | None
    by: str


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
    """The expressions of the functions' bodies; nothing in a text, an annotation, a default or a raise."""
    for function in ast.walk(tree):
        if isinstance(function, ast.FunctionDef):
            for statement in function.body:
                yield from _within(statement)


def _within(node: ast.AST) -> Iterator[ast.AST]:
    if isinstance(node, ast.JoinedStr | ast.Raise | ast.FunctionDef | ast.ClassDef | ast.Import | ast.ImportFrom):
        return
    if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
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


# -- who notices it --------------------------------------------------------------------------------


class Copy:
    """A copy of the repository in which one line at a time is another one."""

    def __init__(self, folder: Path, chart: LineMap | None) -> None:
        self.folder = folder
        self._times = count(1)
        self._map = chart
        for name in COPIED:
            if (ROOT / name).is_dir():
                shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
            else:
                shutil.copy(ROOT / name, folder / name)

    def judged(self, mutant: Mutant) -> Verdict:
        """Which stage notices it first."""
        path = self.folder / mutant.path
        text = path.read_text(encoding="utf-8")
        lines = text.splitlines(keepends=True)
        lines[mutant.line - 1] = mutant.after + "\n"
        self._write(path, "".join(lines))
        try:
            for stage, seconds in zip(STAGES, SECONDS, strict=True):
                arguments = self._arguments(stage, mutant) if self._map is None else self._covering(stage, mutant)
                by = self._failing(arguments, seconds) if arguments else ""
                if by:
                    return Verdict(stage, by)
            return Verdict(None, mutant.why_same or "")
        finally:
            self._write(path, text)

    def _write(self, path: Path, text: str) -> None:
        """Write with a time of its own: Python takes a compiled file for good where time and length are the same."""
        path.write_text(text, encoding="utf-8")
        stamp = 1_000_000_000 + 10 * next(self._times)
        os.utime(path, (stamp, stamp))

    def _arguments(self, stage: str, mutant: Mutant) -> list[str]:
        if stage == "scenes":
            return list(SCENES)
        rooms = sorted(path.name for path in (self.folder / "tests").iterdir() if any(path.glob("test_*.py")))
        order = [mutant.room, "relations", "mobility", "configuration", "integrability", "classification", "exact"]
        order = sorted(rooms, key=lambda room: order.index(room) if room in order else len(order))
        chosen = [*(f"tests/{room}" for room in order), *(f"--deselect={path}" for path in SCENES)]
        return [*chosen, "-m", "sweep"] if stage == "sweeps" else chosen

    def _covering(self, stage: str, mutant: Mutant) -> list[str]:
        """The tests of a stage that run the line, in a file of arguments; none where no test does."""
        found = [] if self._map is None else self._map.tests(mutant)
        scenes = [test for test in found if test.startswith(SCENES)]
        own = f"tests/{mutant.room}/"
        others = sorted((t for t in found if t not in scenes), key=lambda t: (not t.startswith(own), t))
        chosen = scenes if stage == "scenes" else others
        which = "sweep" if stage == "sweeps" else "not sweep"
        (self.folder / "chosen.txt").write_text("\n".join(["-m", which, *chosen]), encoding="utf-8")
        return ["@chosen.txt"] if chosen else []

    def _failing(self, arguments: Sequence[str], seconds: int) -> str:
        """The first test that fails, with how; nothing where all pass."""
        command = [sys.executable, "-m", "pytest", "-n0", "-x", "-p", "no:cacheprovider", "--tb=no", *arguments]
        settings: dict[str, Any] = {"cwd": self.folder, "env": {**os.environ, "PYTHONPATH": str(self.folder)}}
        settings |= {"capture_output": True, "text": True, "timeout": 4 * seconds}
        try:
            done = subprocess.run(command, check=False, preexec_fn=partial(_bound, seconds), **settings)
        except subprocess.TimeoutExpired:
            return "waits for ever"
        if done.returncode == -signal.SIGTERM:
            raise KeyboardInterrupt
        failed = re.findall(r"^(?:FAILED|ERROR) (.+)$", done.stdout, re.MULTILINE)
        if done.returncode in (0, 5):
            return ""
        return failed[0] if failed else f"ended with status {done.returncode} (no end, no memory, or no import)"


def _bound(seconds: int) -> None:
    if sys.platform != "win32":
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 10))
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


class LineMap:
    """Which tests run which lines, as coverage.py measured it."""

    def __init__(self, path: Path) -> None:
        self._data = CoverageData(str(path))
        self._data.read()
        self._files = {Path(name).as_posix(): name for name in self._data.measured_files()}

    def tests(self, mutant: Mutant) -> list[str]:
        """The tests that run a line of the statement."""
        name = next((own for path, own in self._files.items() if path.endswith(mutant.path)), None)
        by_line = {} if name is None else self._data.contexts_by_lineno(name)
        contexts = {c for line in _statement(mutant) for c in by_line.get(line, ())}
        return sorted(found for c in contexts if (found := _test_of(c)) is not None)


def _statement(mutant: Mutant) -> range:
    """The lines of the smallest statement around a line."""
    tree = ast.parse((ROOT / mutant.path).read_text(encoding="utf-8"))
    around = [
        range(node.lineno, (node.end_lineno or node.lineno) + 1)
        for node in ast.walk(tree)
        if isinstance(node, ast.stmt) and node.lineno <= mutant.line <= (node.end_lineno or node.lineno)
    ]
    return min(around, key=len)


def _test_of(context: str) -> str | None:
    """``tests/room/test_x.py::test_y`` from a context's dotted name."""
    parts = context.split(".")
    ends = [k for k in range(1, len(parts)) if (ROOT / "/".join(parts[:k])).with_suffix(".py").is_file()]
    return None if not ends else "::".join(["/".join(parts[: ends[-1]]) + ".py", *parts[ends[-1] :]])


def measure(path: Path, workers: int) -> None:
    """Run all tests, sweeps included, and write which of them run which lines of the deciding rooms."""
    include = ",".join(f"dofkit/{room}" + ("" if room.endswith(".py") else "/*") for room in ROOMS)
    with tempfile.TemporaryDirectory() as folder:
        settings = Path(folder) / "rc"
        settings.write_text(f"[run]\ndynamic_context = test_function\ninclude = {include}\n", encoding="utf-8")
        files = sorted((ROOT / "tests").rglob("test_*.py"), key=lambda p: p.stat().st_size)
        parts = [files[k::workers] for k in range(workers)]
        running = [subprocess.Popen(_measured(settings, Path(folder) / f"part.{k}", p)) for k, p in enumerate(parts)]
        for one in running:
            one.wait()
        together = CoverageData(str(path))
        for k in range(workers):
            together.update(_read(Path(folder) / f"part.{k}"))
        together.write()


def _measured(settings: Path, data: Path, files: Sequence[Path]) -> list[str]:
    """A run of some files of tests under coverage."""
    run = ["-m", "coverage", "run", f"--rcfile={settings}", f"--data-file={data}", "-m", "pytest", "-n0"]
    names = [str(file.relative_to(ROOT)) for file in files]
    return [sys.executable, *run, "-q", "-p", "no:cacheprovider", "-m", "sweep or not sweep", *names]


def _read(path: Path) -> CoverageData:
    data = CoverageData(str(path))
    data.read()
    return data


def table(chosen: Mapping[int, Mutant], workers: int, chart: Path | None) -> Iterator[tuple[int, Verdict]]:
    """Every mutant with who noticed it, in order."""
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(workers) as threads:
        copies: SimpleQueue[Copy] = SimpleQueue()
        for number in range(workers):
            (place := Path(folder) / str(number)).mkdir()
            copies.put(Copy(place, None if chart is None else LineMap(chart)))

        def judged(mutant: Mutant) -> Verdict:
            copy = copies.get()
            try:
                return copy.judged(mutant)
            finally:
                copies.put(copy)

        yield from zip(chosen, threads.map(judged, chosen.values()), strict=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--many", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--only", type=lambda text: [int(number) for number in text.split(",")])
    parser.add_argument("--map", type=Path, help="what --measure wrote")
    parser.add_argument("--measure", type=Path, help="write which tests run which lines, and no more")
    parser.add_argument("--list", action="store_true", help="only show what would be changed")
    given = parser.parse_args()
    if given.measure:
        measure(given.measure, given.workers)
        return
    chosen = dict(enumerate(drawn(given.many, given.seed)))
    chosen = {number: chosen[number] for number in given.only or chosen}
    if given.list:
        print(*(f"{number:>3}  {mutant}" for number, mutant in chosen.items()), sep="\n")
        return
    found: Counter[str] = Counter()
    for number, verdict in table(chosen, given.workers, given.map):
        same = verdict.stage is None and bool(verdict.by)
        found[verdict.stage or ("same" if same else "unnoticed")] += 1
        print(f"{number:>3}  {verdict.stage or ('same' if same else 'UNNOTICED'):<10} {chosen[number]}", flush=True)
        print(f"     {verdict.by}", flush=True)
    print(", ".join(f"{number} {name}" for name, number in found.items()), f"of {sum(found.values())}")


if __name__ == "__main__":
    main()
