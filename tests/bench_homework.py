"""How fast homework is graded on this machine: what is asked, and what was measured. Run it; it is no test.

python tests/bench_homework.py [students]
"""

from __future__ import annotations

import json
import os
import random
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import dofkit
from dofkit.base.documents import read_document
from dofkit.homework.answers.submission import of_value
from dofkit.homework.grading import Grader

STUDENTS = int(sys.argv[1]) if len(sys.argv) > 1 else 100_000
SCENES: dict[str, dict[str, Any]] = {
    "rod": {
        "dimension": 2,
        "parameters": {"l": "positive"},
        "particles": ["A"],
        "constraints": [{"name": "rod", "type": "link", "between": [[0, 0], "A"], "length": "l"}],
    },
    "disc": {
        "parameters": {"R": "positive"},
        "coordinates": ["x", "y", "theta", "phi"],
        "constraints": [
            {"name": "forward", "type": "equation", "text": "dx = R cos(theta) dphi"},
            {"name": "sideways", "type": "equation", "text": "dy = R sin(theta) dphi"},
        ],
    },
    "slope": {
        "parameters": {"R": "positive"},
        "coordinates": ["s", "phi"],
        "constraints": [{"name": "roll", "type": "equation", "text": "ds = R dphi"}],
    },
}
QUESTIONS: dict[str, list[dict[str, Any]]] = {
    "rod": [
        {"id": "f", "ask": "dof"},
        {"id": "k", "ask": "k"},
        {"id": "label", "ask": "label", "constraint": "rod"},
        {"id": "eq", "ask": "equation", "constraint": "rod"},
    ],
    "disc": [
        {"id": "f", "ask": "dof"},
        {"id": "v", "ask": "velocity_dof"},
        {"id": "q", "ask": "coordinates"},
        {"id": "eq", "ask": "equation", "constraint": "forward"},
    ],
    "slope": [{"id": "q", "ask": "coordinates"}, {"id": "int", "ask": "integral", "constraint": "roll"}],
}
ASSIGNMENT = {
    "title": "Ten questions",
    "problems": [{"id": name, "scene": scene, "questions": QUESTIONS[name]} for name, scene in SCENES.items()],
}


def labels(i: int) -> str:
    """A label in one of many spellings; the number is told to make each its own."""
    words = [("holonomic", "non-holonomic", "not holonomic")[i % 3], ("scleronomic", "rheonomic")[i % 2]]
    return (", ", " and ", "  ", " , ")[i % 4].join(words if i % 5 else words[::-1]) + " " * (i // 60)


def names(i: int, *known: str) -> str:
    """Some of the names, in an order of their own."""
    rng = random.Random(i)
    return ", ".join(rng.sample(known, rng.randint(1, len(known)))) + " " * (i // 20)


ANSWERS: dict[str, Callable[[int], Any]] = {
    "rod.f": lambda i: f"{i} - {i} + {i % 4}",
    "rod.k": lambda i: f"{i + i % 3} - {i}",
    "rod.label": labels,
    "rod.eq": lambda i: (
        f"{i + 1} x_A^2 + {i + 1} y_A^2 = {i + 1} l^2",
        f"{i + 1} sqrt(x_A^2 + y_A^2) = {i + 1} l",
        f"x_A^2 + {i + 2} y_A^2 = l^2",
        f"{i + 1} x_A dx_A + {i + 1} y_A dy_A = 0",
    )[i % 4],
    "disc.f": lambda i: f"{i} - {i} + {i % 5}",
    "disc.v": lambda i: f"{i + i % 4} - {i}",
    "disc.q": lambda i: names(i, "x", "y", "theta", "phi"),
    "disc.eq": lambda i: (
        f"{i + 1} dx - {i + 1} R cos(theta) dphi = 0",
        f"{i + 1} xdot = {i + 1} R phidot cos(theta)",
        f"dx = {i + 2} R sin(theta) dphi",
    )[i % 3],
    "slope.q": lambda i: names(i, "s", "phi"),
    "slope.int": lambda i: (f"{i + 1} s - {i + 1} R phi = C", f"s = R phi + {i + 1} c", f"s = {i + 2} R phi")[i % 3],
}


def submission(i: int, vary: int) -> dict[str, Any]:
    """The answers of a student, one of so many who differ."""
    answers: dict[str, dict[str, Any]] = {}
    for place, made in ANSWERS.items():
        problem, question = place.split(".")
        answers.setdefault(problem, {})[question] = made(i % vary)
    return {"student": f"s{i}", "answers": answers}


def told(what: str, asked: str, measured: str) -> None:
    """One line."""
    print(f"{what:<62} {asked:>12} {measured:>12}", flush=True)


def rates() -> None:
    """Answers a second of one core, all of them different."""
    for what, asked, places in (
        ("numbers, labels, names", 300, [p for p in ANSWERS if not p.endswith((".eq", ".int"))]),
        ("equations, integrals", 40, [p for p in ANSWERS if p.endswith((".eq", ".int"))]),
    ):
        grader = Grader(dofkit.load_assignment(ASSIGNMENT))
        many = 60 if asked < 100 else 600
        start = time.process_time()
        for i in range(many):
            whole = submission(i, many)
            for place in places:
                problem, question = place.split(".")
                one = {problem: {question: whole["answers"][problem][question]}}
                grader.grade(of_value({"student": "s", "answers": one}, "s"))
        rate = many * len(places) / (time.process_time() - start)
        told(f"{what}: answers a second and core", f">= {asked}", f"{rate:.0f}")


NATURAL = Path(__file__).parent / "homework" / "natural"
#: Questions whose answers are numbers, labels and names, not equations.
SIMPLE = frozenset({"dof", "velocity_dof", "k", "label", "coordinates", "redundant"})


def natural() -> None:
    """Answers a second of one core, as students write them: solved, on another branch, rewritten, with remarks."""
    took, count = {True: 0.0, False: 0.0}, {True: 0, False: 0}
    for path in sorted(NATURAL.glob("*.yaml")):
        given = read_document(path.read_bytes(), path.name).value
        prepared = dofkit.load_assignment(given.pop("assignment"))
        kinds = {(problem.id, question.id): question.kind() for problem, question in prepared.questions()}
        grader = Grader(prepared)
        for by_place in given.values():
            for place, by_verdict in by_place.items():
                problem, question = place.split(".")
                simple = kinds[problem, question] in SIMPLE
                answers = [
                    {"answers": {problem: {question: answer}}} for some in by_verdict.values() for answer in some
                ]
                start = time.process_time()
                for one in answers:
                    grader.grade(of_value(one, "s"))
                took[simple] += time.process_time() - start
                count[simple] += len(answers)
    for simple, asked in ((True, 300), (False, 40)):
        what = "numbers, labels, names" if simple else "equations, integrals, motion"
        told(f"natural answers, {what}: a second and core", f">= {asked}", f"{count[simple] / took[simple]:.0f}")


def command(folder: Path, *more: str) -> list[str]:
    """The command line that grades the submissions of a folder."""
    return [sys.executable, "-m", "dofkit", "grade", str(folder / "a.json"), *more]


def started(folder: Path) -> float:
    """The time for one submission, all included."""
    one = folder / "one.jsonl"
    one.write_text(json.dumps({"student": "s", "answers": {"rod": {"f": 1}}}))
    took = []
    for _ in range(5):
        start = time.perf_counter()
        subprocess.run(command(folder, str(one)), check=True, stdout=subprocess.DEVNULL)
        took.append(time.perf_counter() - start)
    told("start-up and one answer, seconds", "< 1.5", f"{min(took):.2f}")
    return min(took)


def resident(process: int) -> Iterator[int]:
    """Bytes that a process and those below it hold."""
    try:
        yield int(Path(f"/proc/{process}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")
        for task in Path(f"/proc/{process}/task").iterdir():
            for child in (task / "children").read_text().split():
                yield from resident(int(child))
    except OSError:
        return


def many(folder: Path) -> None:
    """A large course: memory of all processes together, and the time."""
    with (folder / "many.jsonl").open("w") as lines:
        lines.writelines(json.dumps(submission(i, 50)) + "\n" for i in range(STUDENTS))
    start, most = time.perf_counter(), 0
    with subprocess.Popen(command(folder, str(folder / "many.jsonl"), "--out", str(folder / "out.jsonl"))) as running:
        while running.poll() is None:
            most = max(most, sum(resident(running.pid)))
            time.sleep(0.2)
    took = time.perf_counter() - start
    told(f"{STUDENTS} submissions: MB of all processes at most", "< 500", f"{most / 1e6:.0f}")
    told(f"{STUDENTS} submissions of ten answers: submissions a second", "", f"{STUDENTS / took:.0f}")


def twofold(folder: Path, start_up: float) -> None:
    """Two workers against one, when they have started."""
    table = folder / "some.jsonl"
    table.write_text("".join(json.dumps(submission(i, 10**6)) + "\n" for i in range(300)))
    best = {1: float("inf"), 2: float("inf")}
    for _ in range(3):
        for workers in (1, 2):
            start = time.perf_counter()
            line = command(folder, str(table), "--workers", str(workers))
            subprocess.run(line, check=True, stdout=subprocess.DEVNULL)
            best[workers] = min(best[workers], time.perf_counter() - start)
    ratio = (best[1] - start_up) / (best[2] - start_up)
    told("two workers against one, after start-up", ">= 1.7", f"{ratio:.2f}")


def main() -> None:
    """Everything."""
    told("", "asked", "measured")
    rates()
    natural()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "a.json").write_text(json.dumps(ASSIGNMENT))
        twofold(folder, started(folder))
        many(folder)


if __name__ == "__main__":
    main()
