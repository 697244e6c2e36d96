"""Files that are cut, changed or made to hurt: a fault or a scene, and never another exception, nor a long wait."""

from __future__ import annotations

import contextlib
import random
import time
from collections.abc import Iterator

import pytest
from models.sketches import random_sketch
from models.test_urdf import LOOPS, MIMIC, OPEN_LOOP, TREE, robot

import dofkit
from dofkit.base.errors import SceneError

STARTS = {
    "tree": TREE.encode(),
    "mimic": MIMIC.encode(),
    "loop": robot(*OPEN_LOOP, LOOPS["hinge"]).encode(),
    "sketch": random_sketch(3).text().encode("latin-1"),
}
PIECES = (
    b"", b"<", b">", b"'", b"\x00", b"1e999", b"nan", b"-", b"\xff", b"link", b"&a;", b"joint", b"=", b"0", b"\n",
    b"9" * 400,
)  # fmt: skip


def changed(data: bytes, seed: int) -> Iterator[bytes]:
    """Cuts, repeats and pieces put in."""
    rng = random.Random(f"hostile {seed}")
    start = data.index(b"\n") + 1
    for _ in range(25):
        a, b = sorted(rng.randrange(start, len(data)) for _ in range(2))
        b = min(b, a + rng.choice((1, 3, 40)))
        yield data[:a] + rng.choice(PIECES) + data[b:]
    yield data[: rng.randrange(start, len(data))]
    yield data + data


@pytest.mark.parametrize("name", STARTS)
@pytest.mark.parametrize("seed", range(4))
def test_a_changed_file_is_a_scene_or_a_fault(name: str, seed: int) -> None:
    for data in changed(STARTS[name], seed):
        start = time.process_time()
        with contextlib.suppress(SceneError):
            dofkit.loads(data, "hostile")
        assert time.process_time() - start < 5


LARGE = {
    "deep": b"<robot>" + b"<a>" * 100_000,
    "wide": b"<robot>" + b"<link name='a'/>" * 150_000 + b"</robot>",
    "long attribute": b"<robot name='" + b"a" * 5_000_000 + b"'/>",
    "comments": b"<robot>" + b"<!-- -->" * 150_000 + b"</robot>",
    "chain of comments before": b"<!-- -->" * 20_000 + b"<robot/>",
    "records": b"\xb1\xb2\xb3SolveSpaceREVa\n" + b"Entity.h.v=00010001\nAddEntity\n" * 450_000,
}


@pytest.mark.parametrize("name", LARGE)
def test_what_is_too_large_is_refused_in_time(name: str) -> None:
    start = time.process_time()
    with pytest.raises(SceneError):
        dofkit.loads(LARGE[name], "large")
    assert time.process_time() - start < 10


@pytest.mark.sweep
def test_a_tree_of_a_thousand_links_is_read() -> None:
    """A chain as long as Python's own stack is deep."""
    links = "".join(f"<link name='l{k}'/>" for k in range(1500))
    joints = "".join(
        f"<joint name='j{k}' type='continuous'><parent link='l{k}'/><child link='l{k + 1}'/></joint>"
        for k in range(1499)
    )
    assert len(dofkit.loads(f"<robot>{links}{joints}</robot>", "chain").bodies) == 1499
