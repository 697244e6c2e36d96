"""The engines broken on purpose, one line at a time: which scene's certificate shows it? Run it; it is no test.

python tests/broken_engines.py [--only NAME] [--every 1]

Each bug is put into a copy of the package (the checker and what makes certificates are as they are). There the scenes
of the catalog and of the tests are classified, and certified where a claim that is told as proved is another one than
in the sound package: a claim is caught where the sound one has evidence, and the wrong one has none. A bug that changes
no claim is no bug. The sound package is asked first: none of its claims may be contradicted.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

ROOT = Path(__file__).parents[1]


class Bug(NamedTuple):
    """A line of a file as it is, and as it is broken; ``scene``: one whose certificate shows it soon."""

    path: str
    before: str
    after: str
    scene: str


BUGS: Mapping[str, Bug] = {
    "rank": Bug(
        "exact/matrices/sparse.py",
        "return int(residue_matrix([[int(v) for v in row] for row in matrix], p).rank())",
        "return int(residue_matrix([[int(v) for v in row] for row in matrix[1:]], p).rank())",
        "tests/scenes/textbook/gear-pair.yaml",
    ),
    "rank of sparse rows": Bug(
        "exact/matrices/sparse.py",
        "            if residual:\n                self._add(i, residual, used)",
        "            if len(residual) > 1:\n                self._add(i, residual, used)",
        "tests/scenes/mechanisms/rssp-linkage.yaml",
    ),
    "ring": Bug(
        "exact/ring/ring.py",
        "ring.total(ring.product(a[0], b[0]), ring.product(minus, a[1], b[1])),",
        "ring.total(ring.product(a[0], b[0]), ring.product(a[1], b[1])),",
        "tests/scenes/integrability/rubber-spheres-of-equal-size.yaml",
    ),
    "balls": Bug(
        "relations/normal/no_solution.py",
        "        return bool(value > 0) or (not strict",
        "        return bool(value != 0) or (not strict",
        "tests/scenes/corners/wall-that-nothing-satisfies.yaml",
    ),
    "signs": Bug(
        "relations/normal/sign_claims.py",
        "    return solution([_linear_condition(c, order) for c in facts]) is False",
        "    return solution([_linear_condition(c, order) for c in facts]) is not None",
        "tests/scenes/corners/place-told-twice.yaml",
    ),
    "brackets": Bug(
        "integrability/lie_algebra.py",
        "self.full_slope, k) * (-1 / self.base.number(k + 1)))",
        "self.full_slope, k) * (1 / self.base.number(k + 1)))",
        "catalog/l6/x-dy-plus-y-dx.yaml",
    ),
    "pebbles": Bug(
        "mobility/graph/plane.py",
        "                self.redundant.append(i)\n                self._condense",
        "                self._condense",
        "catalog/l6/complete-framework-4-points-in-2d.yaml",
    ),
    "circuits": Bug(
        "classification/dependence/circuits.py",
        "update(self.owners[j] for j in support)",
        "update(self.owners[j] for j in support[:1])",
        "catalog/l6/five-particles-ten-links.yaml",
    ),
    "branches": Bug(
        "relations/normal/zero_set.py",
        "        if not (one_sign and all(never_negative(factors, self.positive) for _, factors in terms)):\n",
        "        if not any(never_negative(factors, self.positive) for _, factors in terms):\n",
        "tests/scenes/mechanisms/plate-between-three-fingers.yaml",
    ),
    "labels": Bug(
        "integrability/traits.py",
        "    if ex.TIME not in e.symbols:\n",
        "    if True:\n",
        "tests/scenes/corners/moving-wall.yaml",
    ),
}
#: What is run in the copy: a line of JSON for each scene: claims told as proved, those with evidence, what is caught.
#: Where it is known what the sound package tells, only scenes that tell something else are certified.
RUN = """
import json, sys
from pathlib import Path
from shared.known_scenes import verdicts_of

import dofkit
from dofkit.checker import verify
from dofkit.methods.certificates.certificate import Certifying
from dofkit.methods.certificates.lowering import document_of_scene

sound = json.loads(Path(sys.argv[1]).read_text()) if sys.argv[1] else None
for path in sys.argv[2:]:
    try:
        scene = dofkit.load(Path(path))
        report = dofkit.classify(scene, budget=None)
        shown, caught = [], []
        told = report.model_dump(mode="json")
        entries = {entry["name"]: entry for entry in told["constraints"]}
        values, proved = {}, []
        for place, _, verdict in verdicts_of(report):
            name, field = place.split("/")[2:] if place.count("/") == 3 else ("", place[1:])
            source = entries[name.replace("~1", "/").replace("~0", "~")] if name else told
            values |= {place: source[field]} if verdict.verdict != "undecided" else {}
            proved += [place] if verdict.verdict == "proved" else []
        if sound is None or any(sound.get(path, {}).get(place, values[place]) != values[place] for place in proved):
            document = document_of_scene(scene)
            making = Certifying(document, report)
            certificate = making.written()
            failed = [one["path"] for one in verify(document, certificate).failed] if certificate["claims"] else []
            shown = [claim["path"] for claim in certificate["claims"]]
            caught = [*map(list, making.contradictions.items()), *([place, "fails"] for place in failed)]
        print(json.dumps([path, values, proved, shown, caught]), flush=True)
    except Exception as error:
        print(json.dumps([path, {}, [], [], [], f"{type(error).__name__}: {error}"[:100]]), flush=True)
"""


class Answers(NamedTuple):
    """Of one scene: what is decided by path, what of it is proved, what shown, what caught with why; an error or ""."""

    values: dict[str, Any]
    proved: list[str]
    shown: list[str]
    caught: list[list[str]]
    error: str = ""


def answers(package: Path, scenes: list[str], sound: Mapping[str, Answers] | None = None) -> dict[str, Answers]:
    """What is told of every scene by the package in a folder; ``sound``: what is known that should be told."""
    with tempfile.TemporaryDirectory() as folder:
        script, known = Path(folder) / "run.py", Path(folder) / "sound.json"
        script.write_text(RUN, encoding="utf-8")
        if sound is not None:
            known.write_text(json.dumps({scene: told.values for scene, told in sound.items()}), encoding="utf-8")
        paths = f"{package}{os.pathsep}{ROOT / 'tests'}"
        environment = {**os.environ, "PYTHONPATH": paths, "PYTHONDONTWRITEBYTECODE": "1"}
        command = [sys.executable, str(script), "" if sound is None else str(known), *scenes]
        process = subprocess.run(
            command, capture_output=True, text=True, env=environment, check=False, timeout=4 * 3600
        )
    if process.returncode:
        raise SystemExit(f"the package in {package} does not run: {process.stderr[-1000:]}")
    lines = [json.loads(line) for line in process.stdout.splitlines() if line.startswith("[")]
    return {line[0]: Answers(*line[1:]) for line in lines}


def broken(bug: Bug, folder: Path) -> Path:
    """A copy of the package with a bug."""
    shutil.copytree(ROOT / "dofkit", folder / "dofkit", ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copytree(ROOT / "catalog", folder / "catalog")
    path = folder / "dofkit" / bug.path
    text = path.read_text(encoding="utf-8")
    if bug.before not in text:
        raise SystemExit(f"{bug.path} has no line {bug.before.strip()}")
    path.write_text(text.replace(bug.before, bug.after, 1), encoding="utf-8")
    return folder


def wrong(sound: Answers, found: Answers) -> list[str]:
    """The paths of what is told as proved, and is something else in the sound package."""
    return [path for path in found.proved if sound.values.get(path, found.values[path]) != found.values[path]]


def row(name: str, sound: Mapping[str, Answers], found: Mapping[str, Answers]) -> str:
    """What a bug changed, and which scene shows it."""
    changed = [(scene, path) for scene, told in found.items() for path in wrong(sound[scene], told)]
    caught = [(scene, path) for scene, path in changed if path in {*sound[scene].shown} - {*found[scene].shown}]
    shown = [(scene, path) for scene, path in changed if path in found[scene].shown]
    places = {scene for scene, *_ in changed}
    scenes = {scene for scene, *_ in caught}
    errors = sum(bool(told.error) for told in found.values()) - sum(bool(told.error) for told in sound.values())
    first = f"{Path(caught[0][0]).stem} {caught[0][1]}" if caught else "NOT CAUGHT"
    counts = f"{len(changed):5d} {len(places):5d} {len(caught):5d} {len(scenes):5d} {errors:5d}"
    lines = [f"{name:<20} {counts}  {first:.120}"]
    told = (f"{Path(scene).stem} {path} {found[scene].values[path]}" for scene, path in shown[:3])
    return "\n".join([*lines, *(f"{'':<20} changed and verified: {one:.150}" for one in told)])


def main() -> None:
    """The table."""
    parser = argparse.ArgumentParser(description="Which certificate shows a bug of the engines.")
    parser.add_argument("--only", default="")
    parser.add_argument("--every", type=int, default=1, help="one in so many scenes")
    given = parser.parse_args()
    places = [*sorted(ROOT.glob("catalog/*/*.yaml")), *sorted(ROOT.glob("tests/scenes/*/*.yaml"))]
    scenes = [str(path) for path in places if path.parent.name != "bad"][:: given.every]
    sound = answers(ROOT, scenes)
    false = [(scene, *one) for scene, told in sound.items() for one in told.caught]
    print(f"{len(sound)} scenes; contradicted in the sound package: {len(false)} {false[:3]}")
    print(
        f"{'bug':<20} proved claims that change, in scenes, claims caught, in scenes, errors; the first that is caught"
    )
    for name, bug in BUGS.items():
        if given.only in ("", name):
            with tempfile.TemporaryDirectory() as folder:
                print(row(name, sound, answers(broken(bug, Path(folder)), scenes, sound)), flush=True)


if __name__ == "__main__":
    main()
