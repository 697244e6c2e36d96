"""Write the record of certainty again, and print what changed: python tests/certainty.py."""

from __future__ import annotations

import time
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import yaml
from shared.known_scenes import EXPECTED, report_of
from shared.report_laws import CERTAINTY, certainty_of

import dofkit
from dofkit.base import deadline

WHOLE = Path(__file__).parent / "whole"


def main() -> None:
    deadline.time = SimpleNamespace(monotonic=time.process_time, thread_time=time.thread_time)  # type: ignore[assignment]
    paths: list[Path] = [getattr(case, "values", [case])[0] for case in EXPECTED]
    record: dict[str, Any] = {path.stem: certainty_of(report_of(path)) for path in sorted(paths, key=lambda p: p.stem)}
    for row in yaml.safe_load((WHOLE / "soundness.yaml").read_text(encoding="utf-8")):
        record[row["case"]] = certainty_of(dofkit.classify(row["scene"]))
    for name in [name for name in record if record[name] != CERTAINTY.get(name)]:
        print(f"{name}:\n  {CERTAINTY.get(name)}\n  {record[name]}")
    table = WHOLE / "certainty.yaml"
    head = "".join(line for line in table.read_text(encoding="utf-8").splitlines(True) if line.startswith("#"))
    body = yaml.safe_dump(record, width=10**6, allow_unicode=True, sort_keys=False, default_flow_style=None)
    table.write_text(head + body, encoding="utf-8")


if __name__ == "__main__":
    main()
