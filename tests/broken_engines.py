"""The engines broken on purpose, one line at a time: which scene's certificate shows it? Run it; it is no test.

python tests/broken_engines.py [--only NAME] [--every 1]

Each bug is put into a copy of the package (the checker and what makes certificates are as they are). There the scenes
of the catalog and of the tests are classified with a certificate, until one is found where a claim is contradicted by
its evidence or fails to verify (``caught``). Told besides: the claims that are told as proved and differ from those of
the sound package, and how many of these are without evidence; a bug that changes no answer is no bug.
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
    """A line of a file as it is, and as it is broken."""

    path: str
    before: str
    after: str


BUGS: Mapping[str, Bug] = {
    "rank": Bug(
        "exact/matrices/modular.py",
        "return int(nmod_mat([[int(v) for v in row] for row in matrix], p).rank())",
        "return min(2, int(nmod_mat([[int(v) for v in row] for row in matrix], p).rank()))",
    ),
    "rank of sparse rows": Bug(
        "exact/matrices/sparse.py", "return echelon(rows, p).rank", "return max(0, echelon(rows, p).rank - 1)"
    ),
    "ring": Bug(
        "exact/ring/angles.py",
        "ring.total(ring.product(a[0], b[0]), ring.product(minus, a[1], b[1])),",
        "ring.total(ring.product(a[0], b[0]), ring.product(a[1], b[1])),",
    ),
    "balls": Bug("exact/zero/identity.py", "return not values(ring, point)[node].contains(0)", "return True"),
    "boxes": Bug(
        "exact/boxes/interval_newton.py", "others = iv.add(before, after[len(parts) - 1 - k])", "others = before"
    ),
    "brackets": Bug(
        "integrability/growth_vector.py",
        "return self.coefficients[k] - self.slope * flow.pulled[k]",
        "return self.coefficients[k]",
    ),
    "pebbles": Bug("mobility/graph/pebbles.py", "            return False, reached\n", "            return True, 0\n"),
    "circuits": Bug(
        "mobility/graph/circuits.py", "        words[b] |= bit\n", "        words[b] |= bit if k else np.uint64(0)\n"
    ),
    "branches": Bug(
        "relations/normal/zero_set.py",
        "        return branches_of(branches, notes)\n",
        "        return branches_of(branches[:1], notes)\n",
    ),
    "labels": Bug(
        "integrability/traits.py",
        "    if ex.TIME not in g.symbols or _factors_without_time(g, positive, never_vanishes):\n",
        "    if True:\n",
    ),
    "cofactors": Bug(
        "classification/dependence/multiples.py",
        "    return all(x * d == y * c for x, y in left)\n",
        "    return True\n",
    ),
}
#: What is run in the copy: a line of JSON for each scene, proved claims, what contradicts them, what is uncovered.
RUN = """
import json, sys
from pathlib import Path
import dofkit
from dofkit.checker import CheckError, verify
from dofkit.methods.certificates.certificate import made
from dofkit.methods.certificates.lowering import document_of_scene
for path in sys.argv[1:]:
    try:
        scene = dofkit.load(Path(path))
        report = dofkit.classify(scene, budget=None)
        document = document_of_scene(scene)
        certificate, contradicted = made(document, report)
        failed = [one["path"] for one in verify(document, certificate).failed]
        told = report.model_dump(mode="json")
        claims = {f"/{k}": told[k] for k, v in report.verdicts.items() if v.verdict == "proved"}
        for one, entry in zip(told["constraints"], report.constraints):
            claims |= {f"/{one['name']}/{k}": one[k] for k, v in entry.verdicts.items() if v.verdict == "proved"}
        shown = ["/" + c["path"].removeprefix("/constraints/").removeprefix("/") for c in certificate["claims"]]
        caught = [*map(list, contradicted), *([path, "fails"] for path in failed)]
        print(json.dumps([scene.name, claims, shown, caught]), flush=True)
    except Exception as error:
        print(json.dumps([Path(path).stem, {}, [], [], f"{type(error).__name__}: {error}"[:100]]), flush=True)
"""


def answers(package: Path, scenes: list[str]) -> dict[str, list[Any]]:
    """What is told of every scene by the package in a folder."""
    with tempfile.NamedTemporaryFile("w", suffix=".py") as script:
        script.write(RUN)
        script.flush()
        environment = {**os.environ, "PYTHONPATH": str(package), "PYTHONDONTWRITEBYTECODE": "1"}
        command = [sys.executable, script.name, *scenes]
        found = subprocess.run(command, capture_output=True, text=True, env=environment, check=False, timeout=1800)
    lines = [json.loads(line) for line in found.stdout.splitlines() if line.startswith("[")]
    return {line[0]: line[1:] for line in lines}


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


def row(name: str, sound: Mapping[str, list[Any]], found: Mapping[str, list[Any]]) -> str:
    """What a bug changed, and which scene shows it."""
    caught = [(scene, one) for scene, told in found.items() for one in told[2]]
    changed = [
        (scene, path, value, sound[scene][0].get(path), path in told[1])
        for scene, told in found.items()
        for path, value in told[0].items()
        if scene in sound and sound[scene][0].get(path, value) != value
    ]
    errors = sum(1 for told in found.values() if len(told) > 3) - sum(1 for told in sound.values() if len(told) > 3)
    shown = [one for one in changed if one[-1]]
    first = f"{caught[0][0]} {caught[0][1][0]}: {caught[0][1][1]}" if caught else "NOT CAUGHT"
    lines = f"{name:<20} {len(changed):5d} {len(shown):5d} {len(caught):5d} {errors:5d}  {first:.110}"
    return "\n".join([lines, *(f"{'':<20} CHANGED AND VERIFIED {one[:4]}" for one in shown[:3])])


def main() -> None:
    """The table."""
    parser = argparse.ArgumentParser(description="Which certificate shows a bug of the engines.")
    parser.add_argument("--only", default="")
    parser.add_argument("--every", type=int, default=1, help="one in so many scenes")
    given = parser.parse_args()
    places = [*sorted(ROOT.glob("catalog/*/*.yaml")), *sorted(ROOT.glob("tests/scenes/*/*.yaml"))]
    scenes = [str(path) for path in places if path.parent.name != "bad"][:: given.every]
    sound = answers(ROOT, scenes)
    print(f"{len(sound)} scenes; columns: proved claims that change, of these verified, claims caught, errors")
    for name, bug in BUGS.items():
        if given.only in ("", name):
            with tempfile.TemporaryDirectory() as folder:
                print(row(name, sound, answers(broken(bug, Path(folder)), scenes)), flush=True)


if __name__ == "__main__":
    main()
