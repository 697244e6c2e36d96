"""Workers: whatever a job does, there is an answer in time, and the next job finds a worker."""

from __future__ import annotations

import json
import math
import os
import signal
import subprocess
import sys
import threading
import time
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from shared import worker_jobs
from shared.late import LONG, let_time_run_out

import dofkit
from dofkit.base.process_limits import SPARE
from dofkit.base.runs import AHEAD, Pool, StoppedError, in_order
from dofkit.base.workers import Job, Worker

HERE = Path(__file__).parents[1]
SMALL = 1 << 29
HARD = {
    "coordinates": ["x", "y", "z", "u", "v"],
    "particles": ["A"],
    "constraints": [
        {"name": "first", "type": "equation", "text": "x dy = du"},
        {"name": "second", "type": "equation", "text": "x^64 y^64 z^64 + 1 = u^64 v^64"},
        "x >= 0",
    ],
}
GOOD = {"coordinates": ["x", "y"], "constraints": ["x dy + y dx = 0"]}
posix = pytest.mark.skipif(os.name == "nt", reason="signals and limits")


@pytest.fixture(scope="module")
def worker() -> Iterator[Worker]:
    made = Worker(SMALL, modules=["shared.worker_jobs"])
    yield made
    made.kill()


def script(code: str, *arguments: str, **options: Any) -> subprocess.CompletedProcess[str]:
    """Run ``code`` as a program of its own that has no guard."""
    paths = os.pathsep.join(filter(None, [str(HERE), str(HERE.parent), os.environ.get("PYTHONPATH")]))
    command = [sys.executable, *(arguments or ("-c", code))]
    settings: dict[str, Any] = {"capture_output": True, "text": True, "timeout": LONG, **options}
    return subprocess.run(command, check=False, env={**os.environ, "PYTHONPATH": paths}, **settings)


def gone(pid: int) -> bool:
    """Does the process end? Nothing that is tested takes as long as this waits."""
    until = time.monotonic() + LONG
    while time.monotonic() < until:
        try:
            os.kill(pid, 0)
            if "\nState:\tZ" in Path(f"/proc/{pid}/status").read_text():
                return True
        except (ProcessLookupError, FileNotFoundError):
            return True
        time.sleep(0.02)
    return False


def written(path: Path) -> int:
    """The number that a job leaves in a file, as soon as it is there."""
    return int(worker_jobs.until(str(path)))


# -- one worker ------------------------------------------------------------------------------------


def test_a_job_is_answered_by_the_same_warm_process(worker: Worker) -> None:
    payload = {"a": [1, 2.5, None, "θ\ud800"], "b": (3,)}
    assert worker.run(Job(worker_jobs.same, payload, 10)).value == {"a": [1, 2.5, None, "θ\ud800"], "b": [3]}
    first, second = (worker.run(Job("shared.worker_jobs:process", None, 10)).value for _ in range(2))
    assert first == second != os.getpid()


def test_what_was_told_last_stands_where_the_job_is_killed(worker: Worker, monkeypatch: pytest.MonkeyPatch) -> None:
    limits = let_time_run_out(monkeypatch, told=3)
    outcome = worker.run(Job(worker_jobs.count, 3, 70, first=30))
    assert (outcome.value, outcome.ended, outcome.finished) == (2, "overrun", False)
    assert outcome.reason == "the worker process was killed after 70 s"
    assert limits == [30, 70, 70, 70]
    let_time_run_out(monkeypatch)
    assert worker.run(Job(worker_jobs.count, 0, 70)).value is None


def test_a_job_is_killed_by_the_clock_alone(worker: Worker) -> None:
    outcome = worker.run(Job(worker_jobs.sleep, LONG, 0.3))
    assert (outcome.value, outcome.reason) == (None, "the worker process was killed after 0.3 s")


@posix
def test_the_clock_runs_from_one_thing_told_to_the_next(worker: Worker) -> None:
    """In the worker too, which ends by itself where the parent is gone; it waits a little longer."""
    heard = worker.run(Job(worker_jobs.alarms, 3, 2 * LONG, first=LONG))
    assert heard.finished
    begun, *others = heard.value
    assert 0 < begun <= LONG + SPARE
    assert all(LONG + SPARE < left <= 2 * LONG + SPARE for left in others)


@pytest.mark.parametrize(
    ("function", "payload", "ended", "reason"),
    [
        (worker_jobs.fail, "no", "failed", "KeyError: 'no'"),
        (worker_jobs.unwritable, None, "failed", "TypeError"),
        (worker_jobs.leave, 3, "died", "the worker process ended with exit status 3"),
        ("shared.worker_jobs:nothing", None, "failed", "no attribute 'nothing'"),
        ("no_such_module:nothing", None, "failed", "ModuleNotFoundError"),
    ],
)
def test_whatever_a_job_does_there_is_an_answer(
    worker: Worker, function: Any, payload: Any, ended: str, reason: str
) -> None:
    outcome = worker.run(Job(function, payload, LONG))
    assert (outcome.value, outcome.ended) == (None, ended)
    assert reason in outcome.reason
    assert worker.run(Job(worker_jobs.same, 7, LONG)).value == 7


@pytest.mark.parametrize("function", [worker_jobs.stuck, worker_jobs.busy])
def test_a_job_that_hangs_is_killed(
    worker: Worker, function: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "pid"
    let_time_run_out(monkeypatch, mark=path)
    outcome = worker.run(Job(function, str(path), LONG))
    assert (outcome.value, outcome.ended) == (None, "overrun")
    assert "killed after 300 s" in outcome.reason
    assert gone(written(path))
    assert worker.run(Job(worker_jobs.same, 7, LONG)).value == 7


@posix
@pytest.mark.parametrize(
    ("function", "ended", "reason"),
    [
        (worker_jobs.hog, "memory", "more than 0.5 GiB of memory would have been needed"),
        (worker_jobs.hog_in_c, "died", "was ended by SIGABRT"),
        (worker_jobs.crash, "died", "was ended by SIGSEGV"),
    ],
)
def test_want_of_memory_and_crashes_end_the_job_only(worker: Worker, function: Any, ended: str, reason: str) -> None:
    outcome = worker.run(Job(function, None, 30))
    assert outcome.ended == ended
    assert reason in outcome.reason
    assert worker.run(Job(worker_jobs.same, 7, 30)).value == 7


@posix
def test_a_worker_that_is_killed_from_outside_is_replaced(tmp_path: Path) -> None:
    worker, path = Worker(), tmp_path / "pid"
    with ThreadPoolExecutor(1) as threads:
        future = threads.submit(worker.run, Job(worker_jobs.busy, str(path), 30))
        os.kill(written(path), signal.SIGKILL)
        assert future.result(LONG).reason == "the worker process was ended by SIGKILL"
    idle = worker.run(Job(worker_jobs.process, None, 30)).value
    os.kill(idle, signal.SIGKILL)
    assert gone(idle)
    assert worker.run(Job(worker_jobs.process, None, 30)).value != idle
    worker.kill()


def test_a_worker_that_cannot_start_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    assert Worker(modules=["no_such_module"]).run(Job(worker_jobs.same, 1, 5)).ended == "absent"
    monkeypatch.setattr(sys, "executable", "/no/such/python")
    outcome = Worker().run(Job(worker_jobs.same, 1, 5))
    assert (outcome.ended, "no worker process could be started" in outcome.reason) == ("absent", True)


def test_a_function_that_no_other_process_can_import_is_refused() -> None:
    with pytest.raises(ValueError, match="cannot import"):
        Worker().run(Job(lambda payload: payload, 1, 5))


def test_a_worker_that_holds_much_memory_is_replaced_after_the_job() -> None:
    worker = Worker(SMALL, modules=["shared.worker_jobs"])
    first, second = (worker.run(Job(worker_jobs.keep, SMALL // 3, 30)).value for _ in range(2))
    assert (first != second) == Path("/proc/self/statm").exists()
    worker.kill()


# -- several ---------------------------------------------------------------------------------------


class Number(NamedTuple):
    """Something of a size."""

    value: int
    size: int = 1


def test_results_come_in_order_and_no_more_is_taken_than_is_needed_soon() -> None:
    taken = list[int]()

    def numbers() -> Iterator[Number]:
        for i in range(500):
            taken.append(i)
            yield Number(i)

    with Pool(2) as pool:
        stream = in_order(pool, lambda n: pool.run(Job(worker_jobs.same, n.value, LONG)).value, numbers())
        assert next(stream) == (Number(0), 0)
        assert len(taken) <= 2 * AHEAD
        assert [value for _, value in stream] == list(range(1, 500))


def test_bad_jobs_do_not_stop_the_others() -> None:
    jobs = [Job(f, p, 30) for f, p in [(worker_jobs.leave, 1), (worker_jobs.fail, ""), (worker_jobs.same, 1)] * 5]
    with Pool(2) as pool:
        ended = Counter(call.result().ended for call in [pool.submit(pool.run, job) for job in jobs])
    assert ended == {"died": 5, "failed": 5, "done": 5}


def test_whoever_stops_early_leaves_nothing_running(tmp_path: Path) -> None:
    path = tmp_path / "pid"
    with Pool(2) as pool:
        busy = pool.submit(pool.run, Job(worker_jobs.busy, str(path), 1e6))
        pid = written(path)
    assert gone(pid)
    with pytest.raises(StoppedError):
        busy.result(LONG)
    with pytest.raises(StoppedError):
        pool.run(Job(worker_jobs.same, 1, LONG))


# -- what is left behind -----------------------------------------------------------------------------

LEFT = """
import os, sys
from shared import worker_jobs
from dofkit.base.workers import Job, Worker
from dofkit.base.runs import Pool
pool = Pool(2)
worker = Worker()
pids = [worker.run(Job(worker_jobs.process, None, 30)).value]
pids += [pool.submit(pool.run, Job(worker_jobs.process, None, 30)).result().value for _ in range(8)]
worker.run(Job(worker_jobs.leave, 1, 30))
print(*set(pids), flush=True)
"""


@posix
@pytest.mark.parametrize("ending", ["", "sys.exit(3)", "raise ValueError", "os.kill(os.getpid(), 9)"])
def test_no_process_is_left_behind(ending: str) -> None:
    ended = script(LEFT + ending)
    pids = [int(pid) for pid in ended.stdout.split()]
    assert pids
    assert all(map(gone, pids))


@pytest.mark.sweep
@posix
@pytest.mark.parametrize("job", ["busy", "stuck"])
def test_a_worker_dies_with_its_parent_in_the_middle_of_a_job(job: str, tmp_path: Path) -> None:
    """In Python it hears that the pipe is closed; inside a library its own alarm ends it."""
    path = tmp_path / "pid"
    imports = f"from dofkit.base.workers import *\nfrom shared.worker_jobs import {job}\n"
    code = f"{imports}Worker().run(Job({job}, {str(path)!r}, 1))"
    paths = os.pathsep.join([str(HERE), str(HERE.parent)])
    with subprocess.Popen([sys.executable, "-c", code], env={**os.environ, "PYTHONPATH": paths}) as parent:
        pid = written(path)
        parent.kill()
    assert gone(pid)


@pytest.mark.sweep
@posix
def test_a_fork_of_the_parent_has_workers_of_its_own() -> None:
    code = LEFT + (
        "pid = os.fork()\n"
        "found = worker.run(Job(worker_jobs.same, 5, 30)).value, pool.run(Job(worker_jobs.same, 5, 30)).value\n"
        "if pid: os.waitpid(pid, 0)\n"
        "print(found, flush=True)\n"
    )
    assert script(code).stdout.splitlines()[1:] == ["(5, 5)", "(5, 5)"]


# -- a scene within its budget -----------------------------------------------------------------------


@pytest.mark.sweep
def test_within_its_budget_a_scene_has_the_same_report() -> None:
    for name in dofkit.catalog_names()[::6]:
        assert dofkit.classify(dofkit.load(name), budget=LONG) == dofkit.classify(dofkit.load(name)), name


def test_without_time_everything_is_undecided_but_named() -> None:
    for budget in (0, 0.001, -1):
        report = dofkit.classify(dofkit.load(HARD), budget=budget)
        assert (report.verdict, report.dof, report.consistent) == ("undecided", None, None)
        assert [entry.name for entry in report.constraints] == ["first", "second", "c3"]


@pytest.mark.sweep
def test_work_that_hears_no_deadline_is_killed(monkeypatch: pytest.MonkeyPatch) -> None:
    """8 coordinates, one finite equation as written: the lecture's count is 7."""
    monkeypatch.setattr("dofkit.methods.classify.WORKER_STAGES", "shared.worker_jobs:sketched")
    monkeypatch.setattr(
        "dofkit.base.runs._shared",
        cache(lambda *_: Pool(1, modules=["shared.worker_jobs", "dofkit.methods.classify"])),
    )
    scene = dofkit.load(HARD)
    limits = let_time_run_out(monkeypatch, told=1)
    report = dofkit.classify(scene, budget=100)
    assert limits == [125, 125]
    assert [(e.form, e.bilateral, e.equations) for e in report.constraints] == [
        ("pfaffian", True, 1), ("finite", True, 1), ("inequality", False, 0),
    ]  # fmt: skip
    assert {e.verdict for e in report.constraints} == {report.verdict} == {"undecided"}
    assert report.count.coordinates == 8
    assert report.count.naive_dof == 7
    assert report.constraints[1].reason == "Not decided: the worker process was killed after 125 s."
    assert report.warnings == ["Nothing was decided: the worker process was killed after 125 s."]
    monkeypatch.undo()
    assert dofkit.classify(dofkit.load(GOOD), budget=LONG).dof == 1


def test_faults_come_back_as_they_are() -> None:
    made = {"coordinates": ["x"], "constraints": ["dx + 1 = 0", "x = 1"]}
    scene = dofkit.Scene.model_validate({"name": "bad", **made})
    told = []
    for budget in (None, LONG):
        with pytest.raises(dofkit.SceneError) as caught:
            dofkit.classify(scene, budget)
        told.append((caught.value.faults, caught.value.source, str(caught.value)))
    assert told[0] == told[1]


def test_a_budget_is_a_number() -> None:
    with pytest.raises(ValueError, match="seconds"):
        dofkit.classify(dofkit.load(GOOD), budget=math.nan)
    assert dofkit.classify(dofkit.load(GOOD), budget=math.inf).dof == 1


def test_where_no_process_can_start_the_time_is_watched(monkeypatch: pytest.MonkeyPatch) -> None:
    import dofkit.base.runs as pools

    monkeypatch.setattr(sys, "executable", "/no/such/python")
    monkeypatch.setattr(pools, "_shared", lambda *_: Pool(1))
    report = dofkit.classify(dofkit.load(GOOD), budget=LONG)
    assert report.dof == 1
    assert "nothing would have been killed" in report.warnings[-1]


def test_scenes_in_many_threads() -> None:
    plain = dofkit.classify(dofkit.load(GOOD))
    with ThreadPoolExecutor(6) as threads:
        found = list(threads.map(lambda _: dofkit.classify(dofkit.load(GOOD), budget=300), range(24)))
    assert all(report == plain for report in found)
    assert threading.active_count() < 20


UNGUARDED = """
print("once")
import dofkit
print(dofkit.classify(dofkit.load({"coordinates": ["x", "y"], "constraints": ["x dy + y dx = 0"]}), budget=300).dof)
"""


@pytest.mark.sweep
def test_a_script_needs_no_guard(tmp_path: Path) -> None:
    (tmp_path / "script.py").write_text(UNGUARDED)
    for told in (script(UNGUARDED), script("", str(tmp_path / "script.py"))):
        assert (told.stdout.split(), told.stderr) == (["once", "1"], "")


@pytest.mark.sweep
@posix
def test_closed_standard_streams_do_no_harm(tmp_path: Path) -> None:
    report = f"dofkit.classify(dofkit.load({GOOD}), budget=300)"
    closed = "import os, dofkit\nfor i in range(3): os.close(i)\n"
    script(closed + f"open('told', 'w').write({report}.verdict)", cwd=tmp_path)
    assert (tmp_path / "told").read_text() == "proved"


@pytest.mark.sweep
def test_a_file_in_the_working_folder_is_not_run(tmp_path: Path) -> None:
    for name in ("flint.py", "struct.py", "dofkit.py"):
        (tmp_path / name).write_text("open('it-ran', 'w')")
    code = "import os, sys; sys.path[:] = [p for p in sys.path if p]\n" + UNGUARDED
    assert script(code, cwd=tmp_path).stdout.split() == ["once", "1"]
    assert not (tmp_path / "it-ran").exists()


# -- the command line ----------------------------------------------------------------------------------


STUCK = """
import sys, dofkit.interface.answers as telling, dofkit.interface.entry
from pathlib import Path
import pytest
from shared import worker_jobs
from shared.late import let_time_run_out
mark = sys.argv.pop(1)
let_time_run_out(pytest.MonkeyPatch(), 1, Path(mark))
real = telling.classified
def classified(scene, *others):
    if scene.name.startswith("stuck"):
        worker_jobs.stuck(mark)
    return real(scene, *others)
telling.classified = classified
sys.argv = ["dofkit", "classify", *sys.argv[1:]]
dofkit.interface.entry.main()
"""


@pytest.mark.sweep
@posix
def test_a_scene_without_end_does_not_stop_the_others(tmp_path: Path) -> None:
    files = [tmp_path / name for name in ("first.json", "stuck.json", "last.json")]
    for file in files:
        file.write_text(json.dumps(GOOD))
    told = script("", "-c", STUCK, str(tmp_path / "one"), "--json", "--budget", "300", *map(str, files))
    reports = [json.loads(line) for line in told.stdout.splitlines()]
    assert (told.returncode, told.stderr) == (0, "")
    assert [(r["scene"], r["verdict"]) for r in reports] == [
        ("first", "proved"), ("stuck", "undecided"), ("last", "proved"),
    ]  # fmt: skip
    told = script("", "-c", STUCK, str(tmp_path / "two"), "--budget", "300", str(files[1]))
    assert "Nothing was decided: the worker process was killed after" in " ".join(told.stdout.split())


CRASHING = """
import sys, dofkit.interface.answers as telling, dofkit.interface.entry
from pathlib import Path
import pytest
from shared import worker_jobs
from shared.late import let_time_run_out
mark = sys.argv.pop(1)
let_time_run_out(pytest.MonkeyPatch(), 0, Path(mark))
real = telling.SceneFile.read
def read(data, name, *more):
    if name in ("crash", "busy"):
        getattr(worker_jobs, name)(mark)
    return real(data, name, *more)
telling.SceneFile.read = read
sys.argv = ["dofkit", "classify", *sys.argv[1:]]
dofkit.interface.entry.main()
"""


@pytest.mark.sweep
@posix
@pytest.mark.parametrize("how", ["crash", "busy"])
def test_a_file_that_kills_its_reader_is_an_error_on_its_line(how: str, tmp_path: Path) -> None:
    for name in (how, "good"):
        (tmp_path / f"{name}.json").write_text(json.dumps(GOOD))
    files = [str(tmp_path / f"{name}.json") for name in ("good", how, "good")]
    told = script("", "-c", CRASHING, str(tmp_path / "one"), "--json", *files)
    lines = [json.loads(line) for line in told.stdout.splitlines()]
    assert (told.returncode, told.stderr) == (2, "")
    assert [line["scene"] for line in lines] == ["good", how, "good"]
    assert lines[1]["error"]["message"].startswith("it could not be read: the worker process was")
    told = script("", "-c", CRASHING, str(tmp_path / "two"), files[1])
    assert (told.returncode, told.stdout) == (2, "")
    assert told.stderr.startswith(f"{files[1]}: error: it could not be read")


@pytest.mark.sweep
@posix
def test_a_pipe_is_a_file(tmp_path: Path) -> None:
    (tmp_path / "good.json").write_text(json.dumps(GOOD))
    line = f"{sys.executable} -m dofkit classify --json <(cat good.json) -"
    told = script("", "-c", f"import subprocess\nsubprocess.run(['bash', '-c', {line!r}], check=True)",
                  cwd=tmp_path, input="coordinates: [x]\n")  # fmt: skip
    assert [json.loads(line)["dof"] for line in told.stdout.splitlines()] == [1, 1]
