"""What the own problem of a student says, and what is right of it: for who decides an answer to it."""

from __future__ import annotations

from contextlib import suppress

from dofkit.homework.assignment import Prepared
from dofkit.homework.own_sheets import NobodysSheetError, SheetDrawer
from dofkit.homework.review.queue import Queue, QueuedAnswer
from dofkit.homework.sentences.translations import say
from dofkit.homework.statement import named

#: Answers whose variants are told: each may take a sheet to be made again.
MOST_TOLD = 1000


def tell_variants(queue: Queue, prepared: Prepared) -> None:
    """Put beside every open answer what its problem says, where everyone has another."""
    if prepared.assignment.variants is None:
        return
    drawer = SheetDrawer(prepared)
    sheets: dict[str, Prepared] = {}
    for queued in queue.open_answers()[:MOST_TOLD]:
        student = queued.students[0]
        with suppress(NobodysSheetError):
            if student not in sheets:
                sheets[student] = drawer.own(student)
            queued.variant = _told(queued, sheets[student])


def _told(queued: QueuedAnswer, sheet: Prepared) -> str:
    key = sheet.keys[queued.item.problem]
    says = "; ".join(f"{name}: {one.in_words}" for name, one in named(key.scene).items())
    questions = {(problem.id, question.id): question for problem, question in sheet.questions()}
    solution = questions[queued.item.problem, queued.item.question].solution(key)
    right = (say(solution) if isinstance(solution, str) else solution).told(sheet.assignment.language)
    return f"{queued.item.variant}: {says}. {right}".strip()
