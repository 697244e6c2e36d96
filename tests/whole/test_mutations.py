"""The changed lines are changed, and still Python."""

from __future__ import annotations

import ast

import mutations
from shared.known_scenes import ROOT

ROOM = ("integrability",)


def test_a_changed_line_is_python() -> None:
    for mutant in mutations.drawn(30, 1, ROOM):
        lines = (ROOT / mutant.path).read_text(encoding="utf-8").splitlines()
        assert lines[mutant.line - 1] == mutant.before != mutant.after
        lines[mutant.line - 1] = mutant.after
        ast.parse("\n".join(lines))


def test_what_is_said_to_change_no_answer_is_a_line_that_there_is() -> None:
    for path, line, _ in mutations.SAME:
        assert line in map(str.strip, (ROOT / path).read_text(encoding="utf-8").splitlines()), (path, line)


def test_what_decides_is_changed_in_every_way() -> None:
    path = ROOT / "dofkit/base/deadline.py"
    found = {(one.before.strip(), one.after.strip()) for one in mutations.mutants(path)}
    assert {
        (
            "return time.monotonic() if clock is None else clock()",
            "return time.monotonic() if clock is not None else clock()",
        ),
        ("if _now() > _until.get():", "if _now() >= _until.get():"),
        ("return max(0.0, _until.get() - _now())", "return max(0.0, _until.get() + _now())"),
    } <= found
    assert not [before for before, _ in found if before.startswith(("raise", "def", '"""'))]
