"""Many scenes at once: in order, kept in a folder, resumed after a kill, one bad file stopping nothing."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from shared.command_line import called
from shared.late import LONG

import dofkit
from dofkit.base.runs import BusyError, Journal, Pool
from dofkit.base.workers import Job, JobOutcome
from dofkit.interface.answers import streams
from dofkit.interface.classification import kept_reports
from dofkit.interface.jobs import Cut, Printed, Request, Run, reply
from dofkit.interface.named_files import named_files
from dofkit.interface.output import Output

BAD = "coordinates: [theta]\nconstraints:\n- thta = 1\n"


def scene(n: int) -> str:
    """n coordinates, of which the first two are equal."""
    names = ", ".join(f"q{k}" for k in range(n))
    return f"coordinates: [{names}]\nconstraints: [q0 = q1]\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Scenes of 2 to 7 coordinates, one with a fault among them."""
    place = tmp_path / "scenes"
    place.mkdir()
    for n in range(2, 8):
        (place / f"s{n}.yaml").write_text(scene(n), encoding="utf-8")
    (place / "s4.yaml").write_text(BAD, encoding="utf-8")
    return place


def told(out: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in (out / "reports.jsonl").read_text(encoding="utf-8").splitlines()]


def dofs(out: Path) -> list[int | None]:
    return [line.get("dof") for line in told(out)]


# Which files


def test_folders_and_patterns_stand_for_what_is_in_them(tmp_path: Path) -> None:
    for name in ("b/z.yaml", "b/a.json", "b/.hidden.yaml", "b/.git/x.yaml", "b/c/r.urdf", "b/notes.txt", "a.yaml"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("coordinates: [x]", encoding="utf-8")
    (tmp_path / "b" / "robot.xml").write_text("<?xml version='1.0'?>\n<!-- a --><mujoco/>", encoding="utf-8")
    (tmp_path / "b" / "package.xml").write_text("<package/>", encoding="utf-8")
    (tmp_path / "empty").mkdir()

    def named(*arguments: str) -> list[str]:
        return [os.path.relpath(file, tmp_path) for file in named_files(str(tmp_path / one) for one in arguments)]

    inside = ["b/a.json", "b/robot.xml", "b/z.yaml", "b/c/r.urdf"]
    assert named("b", "a.yaml") == [*inside, "a.yaml"]
    assert named("*") == ["a.yaml", *inside]
    assert named("**/*.yaml") == ["a.yaml", "b/z.yaml"]
    assert named("no*", "empty", "none.yaml") == ["no*", "empty", "none.yaml"]
    assert named_files(["four-bar-linkage", "-"]) == ["four-bar-linkage", "-"]


# The reports


def test_a_line_for_every_file_in_order(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    status, said, err = called(capsys, "classify", str(folder), "four-bar-linkage", "--out", str(out), "--workers", "2")
    assert (status, err) == (2, "")
    assert "7 scenes in" in said
    assert "1 could not be read" in said
    assert dofs(out) == [1, 2, None, 4, 5, 6, 1]
    assert told(out)[2]["error"]["hint"] == "did you mean `theta`?"
    assert told(out)[0] == dofkit.classify(folder / "s2.yaml").model_dump(mode="json")
    assert sorted(path.name for path in out.iterdir()) == ["reports.jsonl", "reports.jsonl.ledger"]


@pytest.mark.sweep
def test_what_is_printed_is_that_of_one_after_another(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for more in (["--json"], ["--only", "dof"], ["--brief"]):
        found = [called(capsys, "classify", str(folder), *more, *who) for who in ([], ["--workers", "1"])]
        assert found[0][0] == found[1][0] == 2
        assert found[0][2] == found[1][2]
        one, other = (text.partition("6 scenes in")[0] for _, text, _ in found)
        assert one == other


def test_options_that_print_do_not_go_with_a_folder(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, _, err = called(capsys, "classify", str(folder), "--out", "nowhere", "--full")
    assert status == 2
    assert "it cannot be combined with" in err


def request(budget: float = 60.0, file: str = "") -> Request:
    return Request(file, Output(True), budget)


class Counting:
    """Answers with the length of a file, and keeps in mind which were asked about."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.files: list[str] = []
        monkeypatch.setattr("dofkit.interface.jobs.reply", self.answered)
        monkeypatch.setattr(Pool, "fork", lambda pool: None)

    def answered(self, pool: Pool, function: str, request: Request) -> Printed:
        self.files.append(Path(request.file).stem)
        return Printed(f"{len(request.data or b'')}\n", "", 0, {"verdict": "proved", "is": []})

    def run(self, out: Path, files: list[Path], stop: int | None = None, budget: float = 60.0) -> list[str]:
        """Which files are asked about by a run that is stopped after so many."""
        self.files = []
        stream = kept_reports([str(file) for file in files], request(budget), Run(workers=1), out)
        for _, _ in zip(range(len(files) if stop is None else stop), stream, strict=False):
            pass
        if stop is None:
            next(stream, None)
        stream.close()
        return self.files


@pytest.fixture
def counting(monkeypatch: pytest.MonkeyPatch) -> Counting:
    return Counting(monkeypatch)


@pytest.fixture
def files(tmp_path: Path) -> list[Path]:
    found = [tmp_path / f"{name}.yaml" for name in "abcdef"]
    for k, file in enumerate(found):
        file.write_text("x" * (k + 1))
    return found


def lines(out: Path) -> str:
    return "".join((out / "reports.jsonl").read_text().split())


def test_only_what_is_not_there_is_asked(counting: Counting, files: list[Path], tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert counting.run(out, files) == list("abcdef")
    assert (lines(out), counting.run(out, files)) == ("123456", [])
    files[2].write_text("x" * 9)
    assert (counting.run(out, files), lines(out)) == (["c"], "129456")
    assert (counting.run(out, files[::-1]), lines(out)) == ([], "654921")
    assert (counting.run(out, files[:2]), lines(out)) == ([], "12")
    assert (counting.run(out, files, budget=1.0), lines(out)) == (list("abcdef"), "129456")
    (out / "reports.jsonl").unlink()
    assert counting.run(out, files, budget=1.0) == list("abcdef")
    assert sorted(path.name for path in out.iterdir()) == ["reports.jsonl", "reports.jsonl.ledger"]


def test_a_run_that_was_stopped_goes_on(counting: Counting, files: list[Path], tmp_path: Path) -> None:
    out = tmp_path / "out"
    counting.run(out, files)
    files[0].write_text("x" * 7)
    assert counting.run(out, files, stop=2) == ["a"]
    assert lines(out) == "72"
    assert (counting.run(out, files), lines(out)) == ([], "723456")
    assert sorted(path.name for path in out.iterdir()) == ["reports.jsonl", "reports.jsonl.ledger"]


def test_a_damaged_journal_is_begun_anew(counting: Counting, files: list[Path], tmp_path: Path) -> None:
    out = tmp_path / "out"
    for damaged in (b"", b"mark\n", b"SQLite format 3\0" + b"x" * 5000):
        counting.run(out, files)
        (out / "reports.jsonl.ledger").write_bytes(damaged)
        assert (counting.run(out, files), lines(out)) == (list("abcdef"), "123456")


def test_a_journal_keeps_what_is_written_again(tmp_path: Path) -> None:
    path = tmp_path / "folder" / "results.unfinished"
    nothing, a, b = [None, None], ["a", 1], {"b": None}
    for mark, known in (("m", nothing), ("m", [a, b]), ("m", [a, None]), ("n", nothing)):
        journal = Journal(path, mark)
        assert [journal.result(key) for key in "ab"] == known
        journal.write("a", ("a", 1))
        if known == nothing:
            journal.write("b", {"b": None})
        journal.keep_written()
        journal.close()
    Journal(path, "n").remove()
    assert not list(path.parent.iterdir())


def test_two_runs_do_not_write_one_journal(tmp_path: Path) -> None:
    path = tmp_path / "results.unfinished"
    first = Journal(path, "m")
    with pytest.raises(BusyError, match="another run is writing to"):
        Journal(path, "m")
    first.close()
    Journal(path, "m").close()


def test_a_model_that_includes_files_is_analysed_again(tmp_path: Path, counting: Counting) -> None:
    model, alone = tmp_path / "m.xml", tmp_path / "alone.xml"
    model.write_text("<mujoco><include file='deep.xml'/><mesh file='no.stl'/></mujoco>")
    alone.write_text("<mujoco><worldbody/></mujoco>")
    out = tmp_path / "out"
    assert sorted(counting.run(out, [model, alone])) == ["alone", "m"]
    assert counting.run(out, [model, alone]) == ["m"]


# What breaks a worker


class Breaking:
    """A pool whose workers end where they are asked about the scene s3."""

    def run(self, job: Job) -> JobOutcome:
        if (job.payload.request if isinstance(job.payload, Cut) else job.payload).file == "s3":
            return JobOutcome(None, "died", "it ended")
        return JobOutcome(streams(f"{job.payload.file}\n"), "done")


def test_a_scene_that_ends_its_worker_ends_no_other() -> None:
    pool: Any = Breaking()
    printed = [reply(pool, "report_lines", request(file=f"s{k}")) for k in range(6)]
    assert [one.out for one in printed if not one.errors] == ["s0\n", "s1\n", "s2\n", "s4\n", "s5\n"]
    assert "it could not be processed: it ended" in printed[3].out


@pytest.mark.sweep
@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such signals")
def test_a_killed_run_goes_on_where_it_stopped(tmp_path: Path) -> None:
    place, out = tmp_path / "scenes", tmp_path / "out"
    place.mkdir()
    for n in range(60):
        (place / f"s{n:02}.yaml").write_text(scene(2 + n % 7) + f"notes: number {n}\n", encoding="utf-8")
    command = [sys.executable, "-m", "dofkit", "classify", str(place), "--out", str(out), "--workers", "1"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, start_new_session=True) as process:
        reports = out / "reports.jsonl"
        while process.poll() is None and not (reports.exists() and reports.stat().st_size):
            pass
        process.send_signal(signal.SIGKILL)
        process.wait(LONG)
    before = reports.read_bytes()
    with reports.open("ab") as file:
        file.write(b'{"scene": "torn')
    ended = subprocess.run(command, capture_output=True, text=True, check=True)
    assert "60 scenes in" in ended.stdout
    assert dofs(out) == [1 + n % 7 for n in range(60)]
    assert reports.read_bytes().startswith(before.rpartition(b"\n")[0])


@pytest.mark.sweep
def test_a_cluster_gives_the_same_reports(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    import distributed

    library: Any = distributed
    silent = {"silence_logs": 50, "dashboard_address": None}
    with library.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, **silent) as machines:
        address = ["--scheduler", machines.scheduler_address]
        status, _, _ = called(capsys, "classify", str(folder), "--out", str(tmp_path / "there"), *address)
    assert status == 2
    called(capsys, "classify", str(folder), "--out", str(tmp_path / "here"))
    assert told(tmp_path / "there") == told(tmp_path / "here")


def test_a_scheduler_that_does_not_answer_is_reported(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, _, err = called(capsys, "classify", str(folder), "--scheduler", "nonsense://1")
    assert status == 2
    assert "the scheduler at nonsense://1 does not answer" in err or "pip install 'dofkit[cluster]'" in err
