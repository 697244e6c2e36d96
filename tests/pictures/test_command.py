"""Pictures on the command line: where they are written, and what is said of files that cannot be read."""

from __future__ import annotations

from pathlib import Path

import pytest
from shared.command_line import called


def test_one_picture_goes_to_its_file(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    out = tmp_path / "new" / "bar.svg"
    status, told, err = called(capsys, "draw", "four-bar-linkage", "--out", str(out))
    assert (status, told, err) == (0, f"{out}\n", "")
    assert "1 degree of freedom" in out.read_text(encoding="utf-8")


def test_several_go_to_a_folder_and_a_bad_one_stops_none(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    status, told, err = called(capsys, "draw", "four-bar-linkage", "nosuch", "slider-crank", "--out", str(tmp_path))
    assert status == 2
    assert told.split() == [str(tmp_path / "four-bar-linkage.svg"), str(tmp_path / "slider-crank.svg")]
    assert "there is no file 'nosuch'" in err


@pytest.mark.sweep
def test_each_command_names_its_files(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for command in (["draw"], ["draw", "--as", "graph"], ["animate"]):
        assert called(capsys, *command, "four-bar-linkage")[0] == 0
    assert called(capsys, "draw", "--as", "directions", "disc-rolling-on-plane", "--format", "html")[0] == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "disc-rolling-on-plane-directions.html",
        "four-bar-linkage-graph.svg",
        "four-bar-linkage.html",
        "four-bar-linkage.svg",
    ]


def test_the_ending_decides_the_format(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    one = ("draw", "four-bar-linkage", "--out", str(tmp_path / "a.svg"))
    status, _, err = called(capsys, *one, "--format", "pdf")
    assert status == 2
    assert "ends in .svg, but --format asks for pdf" in err
    status, _, err = called(capsys, *one, "slider-crank")
    assert status == 2
    assert "is one file, and 2 scenes are drawn: name a folder" in err
    assert not list(tmp_path.iterdir())


@pytest.mark.sweep
def test_what_is_no_picture_is_reported(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    status, _, err = called(capsys, "draw", "four-bar-linkage", "--out", str(tmp_path / "a.jpg"))
    assert status == 2
    assert "there is no ending '.jpg'" in err
    status, _, err = called(capsys, "draw", "--as", "directions", "four-bar-linkage", "--out", str(tmp_path / "a.svg"))
    assert status == 2
    assert "needs differential constraints" in err
    assert called(capsys, "animate", "four-bar-linkage", "--format", "jpg")[0] == 2
