"""Points for a cell that nbgrader grades: its last line is ``points(...)``.

nbgrader takes the value of a cell's last line through ``float()``. ``-1``, ``True``, ``nan`` and any object give full
marks, and a word on standard error gives none, so that `points` returns a builtin float within the question's points
and writes to standard output alone. (Old versions of nbgrader took 0.0 for full marks, too: there, begin the cell with
``assert points(...) > 0``.)

An answer that could not be decided has half of its points, one that could not be read has none, until a person has
looked: both are listed for the lecturer (`dofkit.homework.stand_ins`). The cell belongs between ``### BEGIN HIDDEN
TESTS`` and ``### END HIDDEN TESTS``: the assignment's file has the key in it.

>>> from dofkit.homework.nbgrader import points
>>> rod = {"name": "rod", "type": "link", "between": [[0, 0], "A"], "length": 1}
>>> scene = {"dimension": 2, "particles": ["A"], "constraints": [rod]}
>>> questions = [{"id": "f", "ask": "dof", "points": 2}]
>>> sheet = {"title": "Sheet 1", "problems": [{"id": "pendulum", "scene": scene, "questions": questions}]}
>>> points(sheet, "pendulum", "f", "f = 1")
pendulum.f: 2 of 2. Correct.
Read as: 1
2.0
"""

from __future__ import annotations

from collections.abc import Mapping

from dofkit.homework.formats.wording import points as told_points
from dofkit.homework.formats.wording import remark, stand_in, title
from dofkit.homework.notebooks import Source, item_of
from dofkit.homework.sentences.translations import in_language
from dofkit.homework.stand_ins import list_open

HALF = "It counts half of the points until a person has reviewed it."
UNREAD = "It counts nothing as long as it cannot be read: write it differently and submit again."


def points(
    assignment: Source, problem: str, question: str, answer: object, others: Mapping[str, object] | None = None
) -> float:
    """The points of one answer, with the feedback printed.

    ``others``: the student's answers to other questions of the problem, for what follows from them. What is left as
    ``...`` is no answer. An answer that could not be decided has half of its points, since a cell is all that nbgrader
    knows: the feedback says that a person has to look, who then sets the points in the formgrader. Raises
    AssignmentError, and QuestionError for a question that is not asked.
    """
    item, language = item_of(assignment, problem, question, None if answer is ... else answer, others or {})
    print(f"{title(item)}: {told_points(item, language)}. {remark(item, language)}")
    list_open([item])
    score = stand_in(item)
    if item.score is None:
        print(in_language(language, HALF if score else UNREAD))
    return min(max(float(score), 0.0), float(item.max_score))
