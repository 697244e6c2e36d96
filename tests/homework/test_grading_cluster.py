"""Grading by a Dask cluster: the same results as here, even where one of its machines is lost on the way."""

from __future__ import annotations

import json
import os
import signal
from functools import partial
from pathlib import Path
from typing import Any

import pytest

import dofkit
from dofkit.base.runs import Cluster, Pool, in_order
from dofkit.homework.answers.sources import Handed
from dofkit.homework.answers.submission import FilePlace
from dofkit.homework.runs.batch import Keeper, Orders, grade_there
from dofkit.interface import cli

pytestmark = pytest.mark.sweep
distributed: Any = pytest.importorskip("distributed", reason="a cluster needs the extra `cluster`")

SCENE = {"coordinates": ["x", "y"], "constraints": [{"name": "circle", "type": "equation", "text": "x^2 + y^2 = 1"}]}
QUESTIONS = [{"id": "f", "ask": "dof"}, {"id": "eq", "ask": "equation", "constraint": "circle"}]
ASSIGNMENT = {"title": "A circle", "problems": [{"id": "p", "scene": SCENE, "questions": QUESTIONS}]}


def handed(number: int) -> list[Handed]:
    """Every third equation says too much; all are different."""
    answers = [{"f": i % 3, "eq": f"{i + 2} x^2 + {i + 2} y^{2 + 2 * (i % 3 == 0)} = {i + 2}"} for i in range(number)]
    return [Handed("", FilePlace("t", i), {"student": f"s{i}", "answers": {"p": a}}) for i, a in enumerate(answers)]


def test_a_lost_worker_loses_no_result(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    made, given = Orders.of(dofkit.load_assignment(ASSIGNMENT)), handed(60)
    with Pool(1) as pool:
        one_by_one = [line for _, line in in_order(pool, Keeper(made, pool).grade, given)]
    assert sum(json.loads(line)["items"][1]["status"] == "right" for line in one_by_one) == 40
    silent = {"silence_logs": 50, "dashboard_address": None}
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, **silent) as machines:
        with distributed.Client(machines.scheduler_address, set_as_default=False) as client:
            processes = sorted(client.run(os.getpid).values())
        assert len(processes) == 2
        told = []
        with Cluster(machines.scheduler_address) as cluster:
            for i, (_, line) in enumerate(in_order(cluster, partial(grade_there, made), given)):
                told.append(line)
                if i == 3:
                    os.kill(processes[0], signal.SIGKILL)
        assert told == one_by_one
        paths = [tmp_path / "a.json", tmp_path / "s.jsonl"]
        paths[0].write_text(json.dumps(ASSIGNMENT))
        paths[1].write_text("".join(json.dumps(h.data) + "\n" for h in given[:5]))
        arguments = ["grade", *map(str, paths), "--scheduler", machines.scheduler_address]
        cli.app(arguments, standalone_mode=False)
    assert capsys.readouterr().out.splitlines() == one_by_one[:5]
