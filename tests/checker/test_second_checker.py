"""Two checkers that share nothing but the page on the format give one answer, and certificates are of its schema.

The second checker is written in JavaScript (`tests/second_checker/`) from ``dofkit/checker/FORMAT.md``.
"""

from __future__ import annotations

import json
import random
import re
import shutil
import subprocess
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator
from shared.known_scenes import CATALOG, SCENES, scene_of, stem, strict_report_of, swept
from shared.tampering import edited, renewed, tampered

from dofkit.checker import CheckError, verify
from dofkit.checker.problem import sha256_of
from dofkit.methods.certificates.lowering import document_of_scene

NODE = shutil.which("node")
SECOND = Path(__file__).parents[1] / "second_checker/main.mjs"
FORMAT = files("dofkit.checker")
SCHEMA = json.loads(FORMAT.joinpath("certificate.schema.json").read_text(encoding="utf-8"))
#: The examples of the page: a certificate, then lines of steps, points and claims.
EXAMPLES = re.findall("```json\n(.*?)```", FORMAT.joinpath("FORMAT.md").read_text(encoding="utf-8"), re.DOTALL)
needs_node = pytest.mark.skipif(NODE is None, reason="node, in which the second checker runs, is not installed")
#: How many changed certificates, and how many changed scenes, a scene has.
MUTATIONS, EDITS = 12, 3
#: Small scenes that need most of the rules; the others are swept.
SMALL = ("non-holonomic-definition", "disc-rolling-on-line", "hoist", "complete-framework-4-points-in-2d")
SAMPLED = [pytest.param(path) if path.stem in SMALL else swept(path) for path in SCENES]
#: A document and a certificate.
Case = tuple[dict[str, Any], dict[str, Any]]


@cache
def certified(path: Path) -> Case:
    """Return a scene's document and its certificate, as JSON."""
    return document_of_scene(scene_of(path)), json.loads(json.dumps(strict_report_of(path).certificate))


def changed(document: dict[str, Any], certificate: dict[str, Any], rng: random.Random) -> Iterator[Case]:
    """Yield the certificate with one change each, and the certificate for scenes with one change each."""
    for _ in range(MUTATIONS):
        change = tampered(certificate, rng)
        if change is not None:
            yield document, json.loads(json.dumps(change.certificate))
    for _ in range(EDITS):
        edit = edited(document, rng)
        if edit is not None:
            yield edit[1], renewed(certificate, edit[1])


def first(case: Case) -> list[str]:
    """Return the first checker's verdict on each claim."""
    document, certificate = case
    paths = [str(claim.get("path")) for claim in certificate["claims"]]
    try:
        verification = verify(document, certificate)
    except CheckError:
        return ["refused"] * len(paths)
    failed = [one["path"] for one in verification.failed]
    twice = {path for path in paths if paths.count(path) > 1}
    return ["unclear" if path in twice else "refused" if path in failed else "accepted" for path in paths]


def second(cases: Sequence[Case]) -> list[list[str]]:
    """Return the second checker's verdicts on each claim of each certificate."""
    lines = [json.dumps({"document": document, "certificate": certificate}) for document, certificate in cases]
    command = [str(NODE), str(SECOND)]
    done = subprocess.run(command, input="\n".join(lines), capture_output=True, text=True, check=True, encoding="utf-8")
    answers = [json.loads(line) for line in done.stdout.splitlines()]
    return [_verdicts(case, answer) for case, answer in zip(cases, answers, strict=True)]


def _verdicts(case: Case, answer: Mapping[str, Any]) -> list[str]:
    if "claims" in answer:
        return [verdict for _, verdict, _ in answer["claims"]]
    return ["refused" if "refused" in answer else "not covered"] * len(case[1]["claims"])


@needs_node
@pytest.mark.parametrize("path", SAMPLED, ids=stem)
def test_the_checkers_agree_on_certificates_and_on_changed_ones(path: Path) -> None:
    document, certificate = certified(path)
    cases = [(document, certificate), *changed(document, certificate, random.Random(path.stem))]
    verdicts = second(cases)
    for case, others in zip(cases, verdicts, strict=True):
        for claim, one, other in zip(case[1]["claims"], first(case), others, strict=True):
            assert {one, other} != {"accepted", "refused"}, (claim, one, other)
    if path in CATALOG:
        assert set(verdicts[0]) == {"accepted"}


@needs_node
def test_a_zero_in_a_large_box_is_as_small_as_the_test_shows() -> None:
    """4 x - 3 is 0 at x = 3/4 alone in a box of any size; there the form's derivative is 1 - 3 x, which is not 0."""
    document = {
        "coordinates": ["x", "y", "z"],
        "constraints": ["4 x = 3", "(x - 1/2) (y dx - x dy) + (x - 1/2) dz = 0"],
    }
    box = {"id": "P", "values": {"x": "3/4", "y": "0", "z": "0"}, "rows": ["c1"], "columns": ["x"], "radius": "1e30"}
    claim = {"path": "/constraints/c2/exact", "value": False, "rule": "not exact", "at": "P", "pair": ["x", "y"]}
    scene = {"name": "scene", "sha256": sha256_of(document)}
    case = document, {"certificate": 1, "scene": scene, "points": [box], "claims": [claim]}
    assert first(case) == second([case])[0] == ["accepted"]


@needs_node
def test_what_the_second_checker_does_not_know_is_not_accepted() -> None:
    document, certificate = certified(next(path for path in CATALOG if path.stem == "simple-pendulum-link"))
    odd = [{**claim, "rule": "of thumb"} for claim in certificate["claims"]]
    unknown = {**document, "constraints": [*document["constraints"], {"type": "wormhole", "between": ["P", "P"]}]}
    cases = [(document, {**certificate, "claims": odd}), (unknown, renewed(certificate, unknown))]
    assert [set(verdicts) for verdicts in second(cases)] == [{"refused"}, {"not covered"}]


@pytest.mark.parametrize("path", SAMPLED, ids=stem)
def test_a_certificate_is_of_the_schema(path: Path) -> None:
    errors = Draft202012Validator(SCHEMA).iter_errors(certified(path)[1])
    assert not [f"{error.json_path}: {error.message}" for error in errors]


def test_the_schema_says_which_it_is_and_refuses_what_is_none() -> None:
    Draft202012Validator.check_schema(SCHEMA)
    assert SCHEMA["$id"] == "urn:dofkit:schema:certificate:1"
    good = {"certificate": 1, "scene": {"name": "scene", "sha256": "0" * 64}, "claims": []}
    claim = {"path": "/dof", "value": 1, "rule": "regular", "about": "reference", "minor": "M0"}
    validator = Draft202012Validator(SCHEMA)
    assert validator.is_valid({**good, "claims": [claim]})
    bad = [{**good, "certificate": 2}, {**good, "evidence": []}, {**good, "claims": [{**claim, "rule": "of thumb"}]}]
    bad += [{**good, "claims": [{**claim, "spare": 1}]}, {**good, "relations": [{"id": "k", "by": "magic"}]}]
    assert not any(map(validator.is_valid, bad))


@needs_node
def test_both_checkers_accept_the_certificate_of_the_page() -> None:
    certificate = json.loads(EXAMPLES[0])
    case = certificate["scene"]["document"], certificate
    assert first(case) == second([case])[0] == ["accepted"]


def test_the_examples_of_the_page_are_of_the_schema_one_for_each_rule() -> None:
    claims = [json.loads(line) for line in EXAMPLES[-1].splitlines()]
    steps, point = [json.loads(line) for line in EXAMPLES[1].splitlines()], json.loads(EXAMPLES[2])
    whole = {**json.loads(EXAMPLES[0]), "relations": steps, "points": [point], "claims": claims}
    assert not [error.message for error in Draft202012Validator(SCHEMA).iter_errors(whole)]
    rules = set(SCHEMA["$defs"]["claim"]["properties"]["rule"]["enum"])
    assert {claim["rule"] for claim in claims} == rules
