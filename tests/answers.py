"""Record every answer of dofkit to a fixed set of scenes, and compare two records.

    python tests/answers.py scenes SCENES.jsonl [MODEL...]    # the catalog, the tests' scenes, trials, models
    python tests/answers.py record SCENES.jsonl OUT.jsonl     # the report and the processor time of each scene
    python tests/answers.py compare BEFORE.jsonl AFTER.jsonl  # same, weaker, stronger, contradicted, and the times

The set of scenes is written once and read by both trees, so that a change of the generators changes no comparison.
A field is *weaker* where a sure value (proved, probable, numeric) became undecided or its verdict fell, *stronger* the
other way round, and *contradicted* where two sure values differ.
"""

from __future__ import annotations

import argparse
import json
import random
import time
from collections import Counter
from collections.abc import Iterable, Iterator
from itertools import islice
from multiprocessing import Pool
from pathlib import Path
from typing import Any

import dofkit
from dofkit.benchmark.trials import FAMILIES

ROOT = Path(__file__).parents[1]
#: Generated trials.
TRIALS = 2000
ORDER = ("proved", "probable", "numeric", "undecided")
#: Fields that are compared: of a report, and of each entry.
FIELDS = (
    "consistent", "feasible", "dof", "velocity_dof", "instantaneous_dof", "singular", "holonomic", "scleronomic",
    "redundant_equations", "redundant", "redundancies", "conflicting", "infeasible", "growth_vector",
)  # fmt: skip
ENTRY_FIELDS = ("form", "holonomic", "holonomic_alone", "scleronomic", "catastatic", "exact", "independent", "circuit")
#: Fields of which several values can be right: only their verdicts are compared.
CHOICES = ("generalized_coordinates", "integral", "integrating_factor", "witness", "joint_coordinates")


def scenes(models: Iterable[str]) -> Iterator[dict[str, Any]]:
    """Yield one row for each scene: its group, its name, and the scene's text, mapping or path."""
    for path in sorted((ROOT / "catalog").glob("*/*.yaml")):
        yield {"group": "catalog", "name": path.stem, "text": path.read_text(encoding="utf-8")}
    for path in sorted((ROOT / "tests/scenes").glob("*/*.yaml")):
        if path.parent.name != "bad":
            yield {"group": f"tests/{path.parent.name}", "name": path.stem, "text": path.read_text(encoding="utf-8")}
    for model in models:
        yield {"group": "models", "name": "/".join(Path(model).parts[-2:]), "path": model}
    yield from _trials()


def _trials() -> Iterator[dict[str, Any]]:
    """Yield the generated trials: an equal share of each family, drawn with a fixed seed, without the catalog's."""
    families = [name for name in sorted(FAMILIES) if not name.startswith("catalog")]
    share = -(-TRIALS // len(families))
    rows: list[dict[str, Any]] = []
    for family in families:
        pool = list(islice((t for t in FAMILIES[family]() if t.size <= 64), 4 * share))
        random.Random(family).shuffle(pool)
        rows += [{"group": f"trials/{family}", "name": t.name, "scene": t.scene} for t in pool[:share]]
    yield from ({**row, "name": f"{i} {row['name']}"} for i, row in enumerate(rows[:TRIALS]))


def _answer(row: dict[str, Any]) -> dict[str, Any]:
    """Return the row's report, or its error, with the processor time that it took."""
    start = time.process_time()
    try:
        source = row.get("path") or row.get("scene")
        scene = dofkit.load(source) if source else dofkit.loads(row["text"])
        report = dofkit.classify(scene).model_dump(mode="json")
    except dofkit.DofkitError as error:
        report = {"error": str(error)}
    except Exception as error:
        report = {"error": f"internal error {type(error).__name__}: {error}"}
    return {"group": row["group"], "name": row["name"], "seconds": time.process_time() - start, "report": report}


def record(source: Path, out: Path, workers: int) -> None:
    """Write the answer to each scene as one JSON line, in the order given."""
    rows = [json.loads(line) for line in source.read_text(encoding="utf-8").splitlines()]
    with Pool(workers) as pool, out.open("w", encoding="utf-8") as file:
        for answer in pool.imap(_answer, rows, chunksize=4):
            file.write(json.dumps(answer) + "\n")


def _values(report: dict[str, Any]) -> Iterator[tuple[str, Any, str]]:
    """Yield (path, value, verdict) of every compared field of a report."""
    if "error" in report:
        yield "error", True, "proved"
        return
    verdicts = report["verdicts"]
    for key in (*FIELDS, *(k for k in CHOICES if k in report)):
        sure = _verdict(verdicts, key, report[key])
        yield key, None if key in CHOICES else _canonical(report[key]), sure
    for entry in report["constraints"]:
        for key in (*ENTRY_FIELDS, *(k for k in CHOICES if k in entry)):
            sure = _verdict(entry["verdicts"], key, entry[key])
            yield f"{entry['name']}.{key}", None if key in CHOICES else _canonical(entry[key]), sure


def _verdict(verdicts: dict[str, Any], key: str, value: Any) -> str:
    """Return the verdict of one field; a field without one is as sure as a proof where it has a value."""
    if key in verdicts:
        return str(verdicts[key]["verdict"])
    return "undecided" if value is None else "proved"


def _canonical(value: Any) -> Any:
    """Return a value in a form in which equal answers are equal texts."""
    if isinstance(value, list):
        return (
            sorted(json.dumps(_canonical(v), sort_keys=True) for v in value)
            if value and not isinstance(value[0], int)
            else value
        )
    if isinstance(value, dict):
        return {k: _canonical(v) for k, v in value.items()}
    return value


def outcome(before: tuple[Any, str], after: tuple[Any, str]) -> str:
    """Return how one field compares: same, weaker, stronger or contradicted."""
    (old, old_sure), (new, new_sure) = before, after
    if "undecided" not in (old_sure, new_sure) and old != new and old is not None and new is not None:
        return "contradicted"
    if old_sure == new_sure:
        return "same" if old == new else "changed while undecided"
    return "weaker" if ORDER.index(new_sure) > ORDER.index(old_sure) else "stronger"


def compare(first: Path, second: Path, detail: int) -> int:
    """Print how two records compare, group by group, and return 1 where anything is contradicted."""
    records = [{(r["group"], r["name"]): r for r in map(json.loads, p.open(encoding="utf-8"))} for p in (first, second)]
    before, after = records
    counts: Counter[tuple[str, str]] = Counter()
    lines: list[str] = []
    for key in before.keys() & after.keys():
        old = {path: (value, sure) for path, value, sure in _values(before[key]["report"])}
        new = {path: (value, sure) for path, value, sure in _values(after[key]["report"])}
        for path in old.keys() | new.keys():
            how = outcome(old[path], new[path]) if path in old and path in new else "field in one only"
            counts[key[0].partition("/")[0], how] += 1
            if how not in ("same", "changed while undecided"):
                lines.append(f"{how:14s} {'/'.join(key)} {path}: {old.get(path)} -> {new.get(path)}")
    for line in sorted(lines)[:detail]:
        print(line[:240])
    for (group, how), number in sorted(counts.items()):
        print(f"{group:10s} {how:24s} {number}")
    shared = sorted(before.keys() & after.keys())
    times = [sum(r[k]["seconds"] for k in shared) for r in records]
    print(f"{len(shared)} scenes; processor time {times[0]:.1f} s before, {times[1]:.1f} s after")
    return int(any(how == "contradicted" for _, how in counts))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["scenes", "record", "compare"])
    parser.add_argument("files", nargs="+", type=Path)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--detail", type=int, default=60, help="how many differing fields are listed")
    given = parser.parse_args()
    if given.what == "scenes":
        rows = "".join(json.dumps(row) + "\n" for row in scenes(map(str, given.files[1:])))
        given.files[0].write_text(rows, encoding="utf-8")
    elif given.what == "record":
        record(*given.files, workers=given.workers)
    else:
        return compare(*given.files, detail=given.detail)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
