"""A whole course, dry: fifty students, four sheets with a variant for each, review, grading again, every platform.

python tests/course.py FOLDER

Everything goes through the command line, as a lecturer would.
"""

from __future__ import annotations

import csv
import io
import json
import os
import random
import shutil
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import yaml

from dofkit.homework.answers.label_words import word_of
from dofkit.homework.assignment import load_assignment
from dofkit.homework.key.compared_equations import equations_of
from dofkit.homework.key.key import Key
from dofkit.homework.questions.labels import truths
from dofkit.homework.variants import sheet_of

STUDENTS, SEED = 50, "autumn"
#: One in so many hands in late, when the first review is done.
LATE = 6
PLATFORMS = ("gradescope", "prairielearn", "canvas", "moodle", "html")
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
#: What a right equation is written beside, so that nobody can read it for certain, and what a person gives for it.
MUMBLED, GIVEN = " hopefully thats it", "0,5"


def _problem(name: str, title: str, scene: Any, *questions: Mapping[str, Any], **more: Any) -> dict[str, Any]:
    return {"id": name, "title": title, "text": f"{title}.", "scene": scene, **more,
            "questions": [{"id": f"q{i + 1}", **question} for i, question in enumerate(questions)]}  # fmt: skip


def _equation(name: str, text: str) -> dict[str, str]:
    return {"name": name, "type": "equation", "text": text}


_ROD = {"name": "rod", "type": "link", "between": [[1, 2], "A"], "length": "[[l]]"}
_LENGTHS = {"vary": {"l": [2, 3, 5]}}
_TURNS = {"vary": {"n": [2, 3, 5]}}
_PENDULUM = {"dimension": 2, "particles": ["A"], "constraints": [_ROD]}
_DOUBLE = {
    "dimension": 2, "particles": ["A", "B"],
    "constraints": [_ROD, {"name": "lower", "type": "link", "between": ["A", "B"], "length": 3}],
}  # fmt: skip
_DISC = {
    "parameters": {"R": "positive"}, "coordinates": ["x", "y", "theta", "phi"],
    "constraints": [_equation("east", "dx = R cos(theta) dphi"), _equation("north", "dy = R sin(theta) dphi")],
}  # fmt: skip
_BLADE = {"coordinates": ["x", "y", "theta"], "constraints": [_equation("blade", "dx sin(theta) = dy cos(theta)")]}
_WIRE = {
    "parameters": {"omega": "positive"}, "coordinates": ["x", "y"],
    "constraints": [_equation("wire", "y cos([[n]] omega t) = x sin([[n]] omega t)")],
}  # fmt: skip
_CYLINDER = {
    "parameters": {"R": "positive"},
    "coordinates": ["s", "phi"],
    "constraints": [_equation("roll", "ds = R dphi")],
}
_F, _K, _Q = {"ask": "dof", "points": 2}, {"ask": "k"}, {"ask": "coordinates"}


def _label(name: str) -> dict[str, Any]:
    return {"ask": "label", "constraint": name}


def _asked(*names: str) -> dict[str, Any]:
    return {"ask": "equation", "constraint": list(names), "points": 4}


SHEETS: dict[str, list[dict[str, Any]]] = {
    "sheet1": [
        _problem("pendulum", "A mass on a rod", _PENDULUM, _F, _K, _label("rod"), _asked("rod"), **_LENGTHS),
        _problem("double", "Two masses on two rods", _DOUBLE, _F, _K, _asked("lower"), **_LENGTHS),
    ],
    "sheet2": [
        _problem("pendulum", "A mass on a rod", _PENDULUM, _F, **_LENGTHS),
        _problem("disc", "A disc rolls upright", _DISC, _F, {"ask": "velocity_dof"}, _label("east"), _asked("east")),
        _problem("blade", "A blade on ice", _BLADE, _F, _label("blade"), _asked("blade")),
    ],
    "sheet3": [
        _problem("double", "Two masses on two rods", _DOUBLE, _F, **_LENGTHS),
        _problem("wire", "A bead on a turning wire", _WIRE, _F, _label("wire"), _asked("wire"), **_TURNS),
        _problem("cylinder", "A cylinder rolls", _CYLINDER, _F, _Q, _label("roll"), _asked("roll")),
    ],
    "sheet4": [
        _problem("linkage", "A four-bar linkage", "four-bar-linkage", _F, _K, {"ask": "redundant"}),
        _problem("pendulum", "A mass on a rod", _PENDULUM, _F, _Q, _asked("rod"), **_LENGTHS),
    ],
}  # fmt: skip


class Ended(NamedTuple):
    """A command that ended."""

    status: int
    out: str
    err: str


def dofkit(folder: Path, *arguments: str | Path, status: Sequence[int] = (0,)) -> Ended:
    """Run a command there; anything but these exit statuses is a failure of the dry run."""
    path = os.pathsep.join(place for place in sys.path if place)
    command = [sys.executable, "-m", "dofkit", *map(str, arguments)]
    env = {**os.environ, "PYTHONPATH": path}
    done = subprocess.run(command, cwd=folder, env=env, capture_output=True, text=True, check=False)
    assert done.returncode in status, (arguments, done.returncode, done.stdout[-2000:], done.stderr[-2000:])
    return Ended(done.returncode, done.stdout, done.stderr)


def write_roster(folder: Path, count: int) -> list[str]:
    """A list of participants with addresses and numbers; the names that results have."""
    names = [f"Student{i:02} Family{i:02}" for i in range(count)]
    lines = ["First name,Last name,ID number,Email address"]
    lines += [f"Student{i:02},Family{i:02},{1000 + i},s{i:02}@uni.example" for i in range(count)]
    (folder / "roster.csv").write_text("\n".join(lines) + "\n")
    return names


def right_answer(key: Key, question: Any) -> str:
    """An answer that is worth all points."""
    kind, report = question.kind(), key.report
    if kind in ("dof", "velocity_dof"):
        return str(getattr(report, kind))
    if kind == "k":
        return str(len(key.coordinates) - (report.dof or 0))
    if kind == "label":
        entry = key.constraints[question.constraint]
        return ", ".join(word_of(part, bool(truths(entry)[part])) for part in question.parts)
    if kind == "equation":
        return equations_of(key, question.constraint)
    found = report.generalized_coordinates if kind == "coordinates" else report.redundant
    return ", ".join(found or ()) or "none"


def written(right: str, kind: str, rng: random.Random) -> str:
    """What a student writes who knows this: most are right, some are not, and some cannot be read."""
    number = kind in ("dof", "velocity_dof", "k")
    lot = rng.random()
    if lot < 0.6:
        return right
    if lot < 0.7:
        return f"f = {right}" if number and kind != "k" else f" {right} "
    if lot < 0.8:
        return "" if rng.random() < 0.3 else str(int(right) + 1) if number else right.replace("non-", "")
    if kind == "equation":
        return right + MUMBLED
    return f"{right} or {int(right) + 1}" if number else f"{right}?" if kind == "label" else f"{right} zzz"


def hand_ins(assignment: Path, folder: Path, students: Sequence[str], rng: random.Random) -> None:
    """A file a student, each with the answers to that student's own sheet."""
    folder.mkdir(exist_ok=True)
    prepared = load_assignment(assignment)
    for number, student in enumerate(students):
        mine = sheet_of(prepared, student)
        answers: dict[str, dict[str, str]] = {}
        for problem, question in mine.questions():
            right = right_answer(mine.keys[problem.id], question)
            answers.setdefault(problem.id, {})[question.id] = written(right, question.kind(), rng)
        whole = {"student": student, "answers": answers}
        (folder / f"{student.split()[0].lower()}-{number:02}.json").write_text(json.dumps(whole))


def filled(table: Path) -> dict[str, float]:
    """Fill in a review as Excel in Germany saves it: half a point for what is mumbled, else nothing; two stay open."""
    rows = list(csv.DictReader(io.StringIO(table.read_bytes().decode("utf-8-sig"), newline="")))
    given: dict[str, float] = {}
    for row in rows[min(2, len(rows) // 3) :]:
        mumbled = row["text"].endswith(MUMBLED)
        row["points"] = GIVEN if mumbled else "0"
        row["remark"] = "Fast richtig, schön." if mumbled else ""
        row["decided_by"] = "Dr. Ng"
        given[row["id"]] = 0.5 if mumbled else 0.0
    stream = io.StringIO()
    writer = csv.DictWriter(stream, list(rows[0]) if rows else [], delimiter=";", lineterminator="\r\n")
    writer.writeheader()
    writer.writerows(rows)
    table.write_bytes(stream.getvalue().encode("cp1252", "replace"))
    return given


def results_of(path: Path) -> dict[str, dict[str, Any]]:
    """The results by student; nobody twice, and what could not be graded is a failure."""
    found = [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]
    assert all(one["error"] is None for one in found), [one["error"] for one in found if one["error"]][:3]
    assert len({one["student"] for one in found}) == len(found)
    for one in found:
        scores = [item["score"] for item in one["items"]]
        assert abs(one["score"] - sum(score or 0.0 for score in scores)) < 1e-9
        assert one["needs_review"] == scores.count(None)
    return {one["student"]: one for one in found}


def decided(results: Mapping[str, dict[str, Any]]) -> Iterator[tuple[str, str, str, float]]:
    """Every answer that a person decided: whose, which, and the points."""
    for student, one in results.items():
        for item in one["items"]:
            if item["decided_by"] is not None:
                yield student, item["problem"], item["question"], item["score"]


def run_sheet(folder: Path, name: str, students: Sequence[str]) -> dict[str, int]:
    """One sheet from the hand-out to every platform; what was counted on the way."""
    rng = random.Random(name)
    source = folder / f"{name}.yaml"
    with source.open("w") as stream:
        yaml.safe_dump(
            {"title": f"{name.capitalize()}", "feedback": "full", "problems": SHEETS[name]}, stream, sort_keys=False
        )
    dofkit(folder, "assignment", "vary", source, "--roster", "roster.csv", "--seed", SEED, "--out", name)
    dofkit(
        folder, "assignment", "handout", f"{name}/assignment.yaml", "--roster", "roster.csv", "--out", f"{name}/sheets"
    )
    varied, answers, out = folder / name / "assignment.yaml", folder / f"{name}-answers", folder / f"{name}-results"
    early = students[: len(students) - len(students) // LATE]
    hand_ins(varied, answers, early, rng)
    grade = ("grade", varied, answers, "--roster", "roster.csv", "--workers", "2")
    dofkit(folder, *grade, "--out", out)
    first = results_of(out / "results.jsonl")
    assert len(first) == len(early)
    given = filled(out / "review.csv")
    hand_ins(varied, answers, students, random.Random(name))
    dofkit(folder, *grade, "--out", out, "--reviewed", out / "review.csv")
    again = results_of(out / "results.jsonl")
    by_hand = list(decided(again))
    assert len(again) == len(students)
    assert given
    assert by_hand
    assert {points for *_, points in by_hand} <= {0.0, 0.5}
    before = (out / "review.csv").read_bytes()
    dofkit(folder, *grade, "--out", out)
    assert list(decided(results_of(out / "results.jsonl"))) == by_hand
    assert (out / "review.csv").read_bytes() == before
    for form in PLATFORMS:
        target = folder / f"{name}-{form}{'.csv' if form in ('canvas', 'moodle') else ''}"
        dofkit(folder, *grade, "--reviewed", out / "review.csv", "--format", form, "--out", target)
        exported(name, form, target, again)
    dofkit(folder, "export", "gradescope", varied, "--reviewed", out / "review.csv", "--out",
           f"{name}.zip")  # fmt: skip
    return {
        "students": len(again), "right": sum(i["status"] == "right" for one in again.values() for i in one["items"]),
        "answers": sum(len(one["items"]) for one in again.values()), "decided": len(by_hand),
        "open before": sum(one["needs_review"] for one in first.values()),
        "open after": sum(one["needs_review"] for one in again.values()),
    }  # fmt: skip


def exported(name: str, form: str, out: Path, results: Mapping[str, dict[str, Any]]) -> None:
    """Hold what a format says of points against the results."""
    table = form in ("canvas", "moodle")
    final = {student: one for student, one in results.items() if not one["needs_review"]}
    if table:
        rows = list(csv.DictReader(io.StringIO(out.read_text(encoding="utf-8-sig"), newline="")))
        rows = [row for row in rows if "Points Possible" not in " ".join(row.values())]
        title = name.capitalize()
        assert len(rows) == len(final), (form, len(rows), len(final))
        assert sorted(float(row[title]) for row in rows) == sorted(round(one["score"], 4) for one in final.values())
    elif form == "html":
        assert len(list((out / "students").glob("*.html"))) == len(results)
        assert (out / "index.html").exists()
        assert (out / "review.html").exists()
    else:
        documents = [json.loads(path.read_text()) for path in sorted(out.glob("*.json"))]
        assert len(documents) == len(results)
        shown = sorted(found for one in documents if (found := points_in(one, results)) is not None)
        wanted = sorted(one["score"] for one in final.values())
        assert [round(a, 6) for a in shown] == [round(b, 6) for b in wanted] or form == "gradescope"


def points_in(document: Mapping[str, Any], results: Mapping[str, dict[str, Any]]) -> float | None:
    """The points that a platform's document gives, where it gives them."""
    most = max(one["max_score"] for one in results.values())
    if "gradable" in document:
        return float(document["score"]) * most if "score" in document else None
    return float(document["score"])


_FRAME = """<iframe id=f src="{page}" width={width} height=900></iframe><p id=o></p><script>
onload = () => {{
  const e = f.contentDocument.documentElement;
  o.textContent = "fits:" + (e.scrollWidth <= e.clientWidth);
}}
</script>"""


def too_wide(pages: Sequence[Path], folder: Path, width: int = 390) -> list[Path]:
    """The pages that have to be moved sideways on a telephone."""
    assert CHROMIUM is not None
    found = []
    for page in pages:
        frame = folder / "fits.html"
        frame.write_text(_FRAME.format(page=page.as_uri(), width=width))
        options = ["--headless", "--no-sandbox", "--disable-gpu", "--allow-file-access-from-files", "--dump-dom"]
        command = [CHROMIUM, *options, f"--user-data-dir={folder / 'profile'}", frame.as_uri()]
        done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)
        if "fits:true" not in done.stdout:
            found.append(page)
    return found


def pages_of(folder: Path) -> list[Path]:
    """Pages of every kind: the overview, the review, two students, and a sheet."""
    found = []
    for name in SHEETS:
        made = folder / f"{name}-html"
        found += [made / "index.html", made / "review.html", *sorted((made / "students").glob("*.html"))[:2]]
        found += sorted((folder / name / "sheets").glob("*.html"))[:1]
    return found


def run(folder: Path, count: int = STUDENTS) -> Iterator[tuple[str, dict[str, int]]]:
    """The whole course there; of each sheet what was counted."""
    folder.mkdir(parents=True, exist_ok=True)
    students = write_roster(folder, count)
    for name in SHEETS:
        yield name, run_sheet(folder, name, students)


def main() -> None:
    """Run it, and say what was counted."""
    folder = Path(sys.argv[1]).resolve()
    count = int(os.environ.get("STUDENTS", STUDENTS))
    for name, counted in run(folder, count):
        print(name, ", ".join(f"{what} {number}" for what, number in counted.items()), flush=True)


if __name__ == "__main__":
    main()
