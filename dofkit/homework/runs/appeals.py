"""Evidence for appeals: of every problem the certificate of what its key rests on, and of answers in equations."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple
from urllib.parse import quote

from dofkit.homework.assignment import Prepared
from dofkit.homework.questions.equations import EquationQuestion
from dofkit.homework.result import Result
from dofkit.methods import certificates
from dofkit.methods.classify import with_certificate

#: What is told of the answers: the file of each, or why there is none.
INDEX = "answers.json"


class JudgedAnswer(NamedTuple):
    """An answer in equations as it was understood, and what it was found to be."""

    problem: str
    question: str
    read_as: str
    status: str


def judged_answers(prepared: Prepared, results: Iterable[Result]) -> Iterator[JudgedAnswer]:
    """The answers to questions for equations that are right, wrong or partly right."""
    asked = {(problem.id, one.id) for problem, one in prepared.questions() if isinstance(one, EquationQuestion)}
    for result in results:
        for item in result.items:
            if (item.problem, item.question) in asked and item.status in ("right", "wrong", "partly"):
                yield JudgedAnswer(item.problem, item.question, item.read_as, item.status)


def write_certificates(prepared: Prepared, folder: Path, answers: Iterable[JudgedAnswer] = ()) -> list[Path]:
    """Write a certificate of each problem's scene, called by the problem, and of answers; the paths written.

    The key's numbers and labels are the report's. A right answer has a certificate for each relation that it says, and
    for each that was asked for; one that is not right has one, of a state that tells them apart. ``answers.json`` names
    them, or says why there are none. All are for `dofkit.verify`. Raises OSError.
    """
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for name, key in prepared.keys.items():
        certificate = with_certificate(key.scene, key.report).certificate
        written.append(_write(folder / f"{quote(name, safe='')}.json", certificate))
    told = [_told_of(prepared, answer, i, folder) for i, answer in enumerate(dict.fromkeys(answers), 1)]
    if told:
        written += [folder / file for one in told for file in one["files"]]
        written.append(_write(folder / INDEX, told))
    return written


def _write(path: Path, what: Any) -> Path:
    path.write_text(json.dumps(what, ensure_ascii=False) + "\n", encoding="utf-8")
    return path


def _told_of(prepared: Prepared, answer: JudgedAnswer, number: int, folder: Path) -> dict[str, Any]:
    """The certificates of one answer, written; or why there are none."""
    question = next(
        one for problem, one in prepared.questions() if (problem.id, one.id) == (answer.problem, answer.question)
    )
    found: list[dict[str, Any]] = []
    why = "it can be read in more than one way"
    if " or " not in answer.read_as and isinstance(question, EquationQuestion):
        key, texts = prepared.keys[answer.problem], [text.strip() for text in answer.read_as.split(";")]
        right = answer.status == "right"
        found, why = certificates.certificates_of(key.scene, question.constraint, texts, key.report, right)
    stem = f"{quote(answer.problem, safe='')}.{quote(answer.question, safe='')}.answer-{number}"
    files = [f"{stem}.{i}.json" for i in range(1, len(found) + 1)]
    for file, certificate in zip(files, found, strict=True):
        _write(folder / file, certificate)
    return {**answer._asdict(), "files": files, **({} if files else {"uncovered": why})}
