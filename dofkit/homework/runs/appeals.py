"""Evidence for appeals: of every problem the certificate of what its key rests on, and of answers in equations."""

from __future__ import annotations

import json
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple
from urllib.parse import quote

from dofkit.homework.assignment import Prepared
from dofkit.homework.key.key import Key
from dofkit.homework.own_sheets import NobodysSheetError, SheetDrawer, mark_told
from dofkit.homework.questions import QuestionBase
from dofkit.homework.questions.equations import EquationQuestion
from dofkit.homework.result import Result
from dofkit.methods.certificates.answers import certificates_of
from dofkit.methods.classify import with_certificate

#: What is told of the answers: the file of each, or why there is none.
INDEX = "answers.json"


class JudgedAnswer(NamedTuple):
    """An answer in equations as it was understood, and what it was found to be.

    ``variant``: the mark of the problem, where every student has another.
    """

    problem: str
    question: str
    read_as: str
    status: str
    variant: str | None = None


class Appeals:
    """Gathers what certificates are about: answers in equations, and the scenes of students with their own sheets."""

    def __init__(self, prepared: Prepared) -> None:
        self._prepared = prepared
        self._asked = {
            (problem.id, one.id) for problem, one in prepared.questions() if isinstance(one, EquationQuestion)
        }
        self._answers: dict[JudgedAnswer, None] = {}
        self._owners: dict[tuple[str, str], str] = {}

    def add(self, result: Result) -> None:
        """One more submission."""
        for item in result.items:
            if item.variant is not None:
                self._owners.setdefault((item.problem, item.variant), result.student)
            if (item.problem, item.question) in self._asked and item.status in ("right", "wrong", "partly"):
                told = JudgedAnswer(item.problem, item.question, item.read_as, item.status, item.variant)
                self._answers[told] = None

    def gather(self, results: Iterable[Result]) -> None:
        """More submissions."""
        for result in results:
            self.add(result)

    def write(self, folder: Path) -> list[Path]:
        """Write a certificate of each problem's scene, called by the problem, and of answers; the paths written.

        The key's numbers and labels are the report's. Where every student has another scene, there is one of each that
        was graded, called by its mark, too. A right answer has a certificate for each relation that it says, and for
        each that was asked for; one that is not right has one, of a state that tells them apart. ``answers.json`` names
        them, or says why there are none. All are for `dofkit.verify`. Raises OSError.
        """
        folder.mkdir(parents=True, exist_ok=True)
        keys = self._keys()
        written = []
        for (problem, variant), key in keys.items():
            certificate = with_certificate(key.scene, key.report).certificate
            written.append(_write(folder / f"{_stem(problem, variant)}.json", certificate))
        questions = {(problem.id, one.id): one for problem, one in self._prepared.questions()}
        told = []
        for number, answer in enumerate(self._answers, 1):
            question = questions[answer.problem, answer.question]
            told.append(_told_of(answer, question, keys.get((answer.problem, answer.variant)), number, folder))
        if told:
            written += [folder / file for one in told for file in one["files"]]
            written.append(_write(folder / INDEX, told))
        return written

    def _keys(self) -> dict[tuple[str, str | None], Key]:
        """The key of every problem, of those that were graded where everyone has another."""
        keys: dict[tuple[str, str | None], Key] = {}
        if self._prepared.assignment.variants is None:
            return {(name, None): key for name, key in self._prepared.keys.items()}
        drawer = SheetDrawer(self._prepared)
        for (problem, variant), student in self._owners.items():
            with suppress(NobodysSheetError):
                keys[problem, variant] = drawer.own(student).keys[problem]
        return keys


def _stem(problem: str, variant: str | None) -> str:
    return quote(problem, safe="") + ("" if variant is None else f".{mark_told(variant)}")


def _write(path: Path, what: Any) -> Path:
    path.write_text(json.dumps(what, ensure_ascii=False) + "\n", encoding="utf-8")
    return path


def _told_of(
    answer: JudgedAnswer, question: QuestionBase, key: Key | None, number: int, folder: Path
) -> dict[str, Any]:
    """The certificates of one answer, written; or why there are none."""
    found: list[dict[str, Any]] = []
    why = "it can be read in more than one way" if key is not None else "its variant could not be reproduced"
    if key is not None and " or " not in answer.read_as and isinstance(question, EquationQuestion):
        texts = [text.strip() for text in answer.read_as.split(";")]
        right = answer.status == "right"
        found, why = certificates_of(key.scene, question.constraint, texts, key.report, right)
    stem = f"{_stem(answer.problem, answer.variant)}.{quote(answer.question, safe='')}.answer-{number}"
    files = [f"{stem}.{i}.json" for i in range(1, len(found) + 1)]
    for file, certificate in zip(files, found, strict=True):
        _write(folder / file, certificate)
    told = {name: each for name, each in answer._asdict().items() if name != "variant" or each is not None}
    return {**told, "files": files, **({} if files else {"uncovered": why})}
