"""What certificates show, and what they cost: the whole table of figures. Run it; it is no test.

python tests/bench_certificates.py [--quick] [--seed 1] [--processes 2] [--list FILE]
[--only coverage,motions,mutations,edits,times,sizes]
--list: with every mutated certificate that was accepted, so that a person can see whether its claim is true.
"""

from __future__ import annotations

import argparse
import json
import random
import re
import statistics
import subprocess
import sys
import tempfile
import time
from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any, NamedTuple

sys.path.insert(0, str(Path(__file__).parent))

from shared.known_scenes import CATALOG, OURS, ROOT
from shared.tampering import accepted, edited, renewed, tampered, untrue

import dofkit
from dofkit.benchmark.trials import FAMILIES
from dofkit.benchmark.trials.construction import few
from dofkit.checker import CheckError
from dofkit.checker.verification import verify
from dofkit.methods.certificates.certificate import Certifying
from dofkit.methods.certificates.lowering import document_of_scene
from dofkit.methods.certificates.motion_evidence import certificate_of_motion
from dofkit.motion.lagrange.model import NoEquationsError
from dofkit.scene.scene import Scene

#: Fields that the issue names: of these all that is proved in the catalog is to be verified.
FIELDS = frozenset((
    *("consistent", "dof", "velocity_dof", "instantaneous_dof", "singular", "redundant", "circuit", "independent"),
    *("conflicting", "holonomic", "holonomic_alone", "scleronomic", "catastatic", "exact", "integrating_factor"),
    *("integral", "growth_vector"),
))  # fmt: skip
#: Seconds of a verification past which a scene is not tampered with a thousand times.
SLOW = 0.4
ADVERSARY = sorted((ROOT / "tests/adversary/found").glob("*.json"))


class Told(NamedTuple):
    """A scene's certificate: the seconds to make and to verify it, and what was said."""

    name: str
    document: dict[str, Any]
    report: dict[str, Any]
    certificate: dict[str, Any]
    reasons: dict[str, str]
    failed: list[dict[str, str]]
    contradictions: dict[str, str]
    seconds: tuple[float, float, float]


def scene_of(given: Path | tuple[str, Mapping[str, Any]]) -> Scene:
    """A scene from a file, or from what a family wrote."""
    if isinstance(given, tuple):
        return dofkit.load({"name": given[0], **given[1]})
    return dofkit.load(json.loads(given.read_text())["scene"] if given.suffix == ".json" else given)


def certified(given: Path | tuple[str, Mapping[str, Any]]) -> Told | str:
    """Everything of a scene; a text where there is none: it is refused, or an error."""
    try:
        scene = scene_of(given)
        start = time.process_time()
        report = dofkit.classify(scene)
        middle = time.process_time()
        document = document_of_scene(scene)
        making = Certifying(document, report)
        certificate = json.loads(json.dumps(making.written()))
        later = time.process_time()
        verification = verify(document, certificate)
        last = time.process_time()
    except dofkit.SceneError as error:
        return f"refused {given}: {str(error)[:80]}"
    except CheckError as error:
        return f"CheckError of {given}: {str(error)[:120]}"
    except Exception as error:
        return f"CRASH of {given}: {type(error).__name__} {str(error)[:120]}"
    reasons = dict(making.reasons)
    seconds = middle - start, later - middle, last - later
    told = report.model_dump(mode="json")
    return Told(scene.name, document, told, certificate, reasons, verification.failed, making.contradictions, seconds)


def others(quick: bool) -> list[tuple[str, Mapping[str, Any]]]:
    """The scenes of the benchmark's families, each once, but for those of the catalog."""
    found: dict[str, tuple[str, Mapping[str, Any]]] = {}
    for name, family in FAMILIES.items():
        if name != "catalog":
            for trial in few(family()):
                key = json.dumps(trial.scene, sort_keys=True, default=str)
                found.setdefault(key, (re.sub(r"\W+", "-", f"{name} {len(found)}"), trial.scene))
    return list(found.values())


# -- coverage ----------------------------------------------------------------------------------------------------------


def plain(reason: str) -> str:
    """A reason without the names in it."""
    return re.sub(r"\d+", "N", re.sub(r"`[^`]*`", "`...`", reason))[:110]


def why(told: Told, path: str) -> str:
    """Why a proved claim is not verified."""
    if path.endswith("/about"):
        return "shown near a point, told of everywhere"
    return plain(told.reasons.get(path, "no evidence is found"))


def coverage(what: str, given: Sequence[Any], goal: str, pool: ProcessPoolExecutor, *, fields: bool) -> list[Told]:
    """The share of proved claims that verify, and the rest by kind and reason."""
    found = list(pool.map(certified, given, chunksize=4))
    told = [one for one in found if isinstance(one, Told)]
    shown, left, rest = 0, Counter[str](), Counter[tuple[str, str]]()
    names: dict[tuple[str, str], list[str]] = defaultdict(list)
    for one in told:
        probable = {f"/{field}" for field, verdict in one.report["verdicts"].items() if verdict["verdict"] != "proved"}
        paths = [claim["path"] for claim in one.certificate["claims"] if claim["path"] not in probable]
        shown += sum(1 for path in paths if not fields or path.rpartition("/")[2] in FIELDS)
        for path in one.certificate["uncovered"]:
            about = path.startswith("/verdicts/")
            kind = path if path.count("/") < 3 or about else f"/constraints/*/{path.rpartition('/')[2]}"
            within = not fields or (path.split("/")[2] if about else path.rpartition("/")[2]) in FIELDS
            left["about" if about else "claim"] += within
            rest[kind, why(one, path)] += 1
            names[kind, why(one, path)].append(one.name)
    total = shown + left["claim"]
    print(
        f"\n{what}: {len(told)} scenes, {shown} of {total} proved claims verify: {shown / max(total, 1):.2%} ({goal});"
    )
    print(f"  besides {left['about']} are shown near a point that are told of everywhere")
    for one in told:
        for fault in one.failed:
            print(f"  FAILED {one.name} {fault}")
        for path, reason in one.contradictions.items():
            print(f"  CONTRADICTED {one.name} {path}: {reason}")
    print(f"  claims that fail: {sum(len(one.failed) for one in told)} (0); contradicted: "
          f"{sum(len(one.contradictions) for one in told)}")  # fmt: skip
    for (kind, reason), count in rest.most_common(40):
        print(f"  {count:5d} {kind:<34} {reason:<96} {', '.join(list(dict.fromkeys(names[kind, reason]))[:3])}")
    for line in (one for one in found if isinstance(one, str) and not one.startswith("refused")):
        print(f"  {line}")
    print(f"  refused by the reader: {sum(1 for one in found if isinstance(one, str) and one.startswith('refused'))}")
    return told


def moved(path: Path) -> tuple[str, dict[str, Any], bool] | None:
    """The certificate of a scene's equations of motion, and whether it verifies; None where there are no equations."""
    try:
        report = dofkit.lagrange(path)
    except (dofkit.SceneError, NoEquationsError):
        return None
    scene = dofkit.load(path)
    certificate = certificate_of_motion(scene, report.model_dump(mode="json"), report.classification)
    return scene.name, certificate, bool(verify(None, json.dumps(certificate)).verified)


def tampered_motion(told: tuple[str, dict[str, Any], bool], many: int = 100) -> list[str]:
    """Of so many mutated certificates those that are accepted though they tell something else."""
    name, certificate, _ = told
    rng, found = random.Random(name), []
    for _ in range(many):
        change = tampered(certificate, rng)
        claims = change.certificate["claims"] if change is not None else []
        if change is None or not claims or claims[0].get("value") == certificate["claims"][0]["value"]:
            continue
        try:
            done = verify(None, change.certificate)
        except CheckError:
            continue
        found += [f"{name}: {change.told}"] if done.verified else []
    return found


def motions(given: Sequence[Path], pool: ProcessPoolExecutor) -> None:
    """Equations of motion: how many are verified, and what is accepted of those that were tampered with."""
    told = [one for one in pool.map(moved, given) if one is not None]
    shown = [one for one in told if one[2]]
    wrong = [line for lines in pool.map(tampered_motion, shown) for line in lines]
    print(f"\nequations of motion: {len(shown)} of {len(told)} verify; accepted with other equations, of "
          f"{100 * len(shown)} that were mutated: {len(wrong)}")  # fmt: skip
    for line in (*wrong, *(f"no evidence: {name}" for name, _, fine in told if not fine)):
        print(f"  {line}")


# -- tampering ---------------------------------------------------------------------------------------------------------


class Outcome(NamedTuple):
    kind: str
    told: str
    accepted: bool
    faults: list[str]


def mutated(told: Told, seed: int) -> Outcome | None:
    """One mutated certificate held against the report that was proved and verified."""
    rng = random.Random(f"{told.name} {seed}")
    change = tampered(told.certificate, rng)
    if change is None:
        return None
    claims = accepted(told.document, change.certificate)
    faults = untrue(claims, told.report, choices=False) if claims is not None else []
    return Outcome(change.kind, f"{told.name}: {change.told}", claims is not None, faults)


def all_mutated(told: Told, seeds: Sequence[int]) -> list[Outcome]:
    return [one for seed in seeds if (one := mutated(told, seed)) is not None]


def tamper(told: Sequence[Told], many: int, seed: int, pool: ProcessPoolExecutor, file: Path | None) -> None:
    """Mutated certificates: how many are accepted, and of those whether all claims are still true."""
    quick = [one for one in told if one.seconds[2] < SLOW and one.certificate["claims"]]
    print(f"\nmutated certificates, of {len(quick)} scenes; {len(told) - len(quick)} others are slow or claim nothing")
    share, counts, shown, lines = many // len(quick) + 1, Counter[str](), Counter[str](), []
    wrong: list[Outcome] = []
    seeds = range(10**6 * seed, 10**6 * seed + 4 * share)
    found = [outcomes[:share] for outcomes in pool.map(all_mutated, quick, [seeds[: share * 3 // 2 + 1]] * len(quick))]
    for one in (one for outcomes in found for one in outcomes):
        counts[one.kind] += 1
        shown[one.kind] += one.accepted
        if one.accepted:
            lines.append(f"{'CHANGED' if one.faults else 'same claims'} {one.kind:<7} {one.told} {one.faults or ''}")
            wrong += [one] if one.faults else []
    for kind in counts:
        print(f"  {kind:<8} {counts[kind]:6d} mutated {shown[kind]:6d} accepted, with all claims as they were proved: "
              f"{shown[kind] - sum(1 for one in wrong if one.kind == kind)}")  # fmt: skip
    print(f"  all      {counts.total():6d} mutated; accepted with another claim: {len(wrong)} (0, but for true ones)")
    for one in wrong:
        print(f"  {one.told}\n      {one.faults}")
    if file is not None:
        file.write_text("\n".join(lines) + "\n", encoding="utf-8")


def all_edited(told: Told, seeds: Sequence[int]) -> list[Outcome]:
    """Edits of a scene: what its certificate, with the hash renewed, still has the checker believe, and `classify`."""
    found = []
    for seed in seeds:
        change = edited(told.document, random.Random(f"{told.name} {seed}"))
        outcome = one_edited(told, *change) if change is not None else None
        found += [outcome] if outcome is not None else []
    return found


def one_edited(told: Told, done: str, scene: dict[str, Any]) -> Outcome | None:
    try:
        report = dofkit.classify(scene, budget=20).model_dump(mode="json")
        certificate = renewed(told.certificate, scene)
        verification = verify(scene, certificate)
    except (dofkit.SceneError, CheckError):
        return None
    failed = {one["path"] for one in verification.failed}
    claims = {c["path"]: (c["value"], c.get("about")) for c in certificate["claims"] if c["path"] not in failed}
    return Outcome(done.split(maxsplit=1)[0], f"{told.name}: {done}", bool(claims), untrue(claims, report))


def edit(told: Sequence[Told], many: int, seed: int, pool: ProcessPoolExecutor) -> None:
    """Edited scenes: the claims that are still verified, against what `classify` proves of the edited scene."""
    quick = [one for one in told if sum(one.seconds) < 2 and one.certificate["claims"]]
    share = many // len(quick) + 1
    seeds = range(10**6 * seed, 10**6 * seed + 4 * share)
    found = [one for outcomes in pool.map(all_edited, quick, [seeds] * len(quick)) for one in outcomes[:share]]
    wrong = [one for one in found if one.faults]
    print(f"\nedited scenes: {len(found)}, with a claim that is still verified: {sum(one.accepted for one in found)}; "
          f"verified where it became false: {len(wrong)} (0)")  # fmt: skip
    for one in wrong:
        print(f"  {one.told}\n      {one.faults}")


# -- time and size -----------------------------------------------------------------------------------------------------


def python(*arguments: str) -> float:
    """Seconds of a fresh dofkit."""
    start = time.perf_counter()
    subprocess.run([sys.executable, "-m", "dofkit", *arguments], capture_output=True, check=False)
    return time.perf_counter() - start


def times(told: Sequence[Told], quick: bool) -> None:
    """Cold: a process for each command; warm: processor time here."""
    chosen = told[:: 10 if quick else 2]
    ratios: dict[str, list[float]] = defaultdict(list)
    with tempfile.TemporaryDirectory() as folder:
        for one in chosen:
            out = str(Path(folder, "certificate.json"))
            plainly, with_one = python("classify", "--json", one.name), python(
                "classify", "--json", one.name, "--certificate", out
            )  # fmt: skip
            ratios["verify"].append(python("verify", one.name, out) / plainly)
            ratios["certificate"].append(with_one / plainly)
    print(f"\ntime, cold, median over {len(chosen)} scenes of the catalog:")
    print(f"  verify against classify                  {statistics.median(ratios['verify']):.2f} (at most 0.5)")
    print(f"  classify --certificate against classify  {statistics.median(ratios['certificate']):.2f} (at most 2.5)")
    warm = [(one.seconds[2] / one.seconds[0], sum(one.seconds[:2]) / one.seconds[0]) for one in told if one.seconds[0]]
    print(f"  warm, over {len(warm)}: verify {statistics.median(v for v, _ in warm):.2f}, "
          f"classify with a certificate {statistics.median(c for _, c in warm):.2f} times classify")  # fmt: skip


def sizes(told: Sequence[Told]) -> None:
    """As it is written, with the scene in it and without."""

    def length(value: Any) -> int:
        return len(json.dumps(value, separators=(",", ":"), ensure_ascii=False).encode())

    whole = {one.name: length(one.certificate) for one in told}
    bare = [length({**one.certificate, "scene": {}}) for one in told]
    most = max(whole, key=lambda name: whole[name])
    print(f"\nsize: median {statistics.median(whole.values()) / 1e3:.1f} kB, without the scene "
          f"{statistics.median(bare) / 1e3:.1f} kB (4); largest (1 MB) {whole[most] / 1e3:.0f} kB, {most}")  # fmt: skip


def main() -> None:
    """Print everything."""
    parser = argparse.ArgumentParser(description="What certificates show, and what they cost.")
    parser.add_argument("--quick", action="store_true", help="a tenth")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--only", default="coverage,motions,mutations,edits,times,sizes")
    parser.add_argument("--list", type=Path, default=None, help="where to write every accepted mutation")
    given = parser.parse_args()
    parts, step = given.only.split(","), 10 if given.quick else 1
    print(f"seed {given.seed}{', a tenth of everything' if given.quick else ''}")
    with ProcessPoolExecutor(given.processes) as pool:
        catalog = coverage("catalog", CATALOG[::step], "100 % of the fields named", pool, fields=True)
        if "coverage" in parts:
            coverage("test scenes", OURS[::step], "at least 95 %", pool, fields=False)
            print("\nother people's: the benchmark's families but for the catalog, and what the adversary found")
            coverage("other scenes", [*others(given.quick), *ADVERSARY][::step], "at least 90 %", pool, fields=False)
        if "motions" in parts:
            motions([*CATALOG, *OURS][::step], pool)
        if "mutations" in parts:
            tamper(catalog, 10_000 // step, given.seed, pool, given.list)
        if "edits" in parts:
            edit(catalog, 2_000 // step, given.seed, pool)
    if "sizes" in parts:
        sizes(catalog)
    if "times" in parts:
        times(catalog, given.quick)


if __name__ == "__main__":
    main()
