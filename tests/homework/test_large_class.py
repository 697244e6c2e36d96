"""A class of a thousand with a natural sheet: graded in less time than it takes to fetch a coffee."""

from __future__ import annotations

import json
import random
import resource
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest

from dofkit.base.documents import read_document

NATURAL = Path(__file__).parent / "natural"
STUDENTS, WORKERS, SECONDS = 1000, 2, 90.0
#: Six questions of numbers, labels and names, and four of equations; where their natural answers stand.
ASKED = {
    "words": ["pend.f", "pend.k", "pend.label", "pend.q", "disc.f", "disc.label"],
    "rewritings": ["rod.eq", "wire.eq", "double.eq", "circle.int"],
}


def sheet_and_pools() -> tuple[dict[str, Any], dict[str, list[str]]]:
    """An assignment of the problems that are asked of, and what students answer by column."""
    problems, pools = [], {}
    for name, places in ASKED.items():
        given = read_document((NATURAL / f"{name}.yaml").read_bytes(), name).value
        known = {problem["id"]: problem for problem in given["assignment"]["problems"]}
        for place in places:
            texts = [
                str(text)
                for part in ("answers", "later", "nearly", "last")
                for some in given.get(part, {}).get(place, {}).values()
                for text in some
            ]
            assert texts, place
            pools[f"{name}-{place}"] = texts
        for one in {place.split(".")[0]: None for place in places}:
            wanted = [q for q in known[one]["questions"] if f"{one}.{q['id']}" in places]
            problems.append({**known[one], "id": f"{name}-{one}", "questions": wanted})
    return {"title": "A large class", "problems": problems}, pools


def own_writing(text: str, rng: random.Random) -> str:
    """The same answer as another student writes it: other blanks, another factor, other exponents."""
    if text.count("=") == 1 and not set(text) & set(";,±|:") and rng.random() < 0.3:
        left, right = text.split("=")
        factor = rng.randint(2, 99)
        text = f"{factor}*({left.strip()}) = {factor}*({right.strip()})"
    if rng.random() < 0.5:
        text = text.replace("^2", "²")
    return text.replace(" = ", rng.choice(["=", " = ", "  =  "])) + " " * rng.randint(0, 3)


@pytest.mark.sweep
def test_a_class_of_a_thousand_takes_less_than_ninety_seconds_on_two_cores(tmp_path: Path) -> None:
    sheet, pools = sheet_and_pools()
    assert sum(len(problem["questions"]) for problem in sheet["problems"]) == len(pools) == 10
    rng = random.Random(16)
    (tmp_path / "sheet.json").write_text(json.dumps(sheet))
    with (tmp_path / "class.jsonl").open("w") as lines:
        for i in range(STUDENTS):
            answers: dict[str, dict[str, str]] = {}
            for place, texts in pools.items():
                problem, question = place.split(".")
                answers.setdefault(problem, {})[question] = own_writing(rng.choice(texts), rng)
            lines.write(json.dumps({"student": f"s{i}", "answers": answers}) + "\n")
    command = [sys.executable, "-m", "dofkit", "grade", "sheet.json", "class.jsonl", "--workers", str(WORKERS)]
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    subprocess.run([*command, "--out", "out"], check=True, cwd=tmp_path, capture_output=True)
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    busy = used.ru_utime + used.ru_stime - before.ru_utime - before.ru_stime
    print(f"{STUDENTS} students: {time.monotonic() - start:.1f} s, {busy:.1f} s of processors")
    assert busy / WORKERS < SECONDS
    results = [json.loads(line) for line in (tmp_path / "out" / "results.jsonl").open()]
    assert len(results) == STUDENTS
    assert all(one["error"] is None and len(one["items"]) == 10 for one in results)
    assert sum(one["needs_review"] > 0 for one in results) > 0
    assert (tmp_path / "out" / "review.csv").exists()
