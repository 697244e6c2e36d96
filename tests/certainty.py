"""Write the record of certainty again, and print what changed: python tests/certainty.py."""

from __future__ import annotations

import time
from pathlib import Path
from types import SimpleNamespace
from unittest.mock import patch

import yaml
from shared.known_scenes import EXPECTED, report_of
from shared.report_laws import CERTAINTY, certainty_of

from dofkit.base import deadline

TABLE = Path(__file__).parent / "whole" / "certainty.yaml"


def main() -> None:
    paths: list[Path] = [getattr(case, "values", [case])[0] for case in EXPECTED]
    with patch.object(deadline, "time", SimpleNamespace(monotonic=time.process_time, thread_time=time.thread_time)):
        certainties = {path.stem: certainty_of(report_of(path)) for path in sorted(paths, key=lambda p: p.stem)}
    record = {name: certainty for name, certainty in certainties.items() if certainty}
    for name in sorted(record.keys() | CERTAINTY.keys()):
        if record.get(name) != CERTAINTY.get(name):
            print(f"{name}:\n  {CERTAINTY.get(name)}\n  {record.get(name)}")
    head = "".join(line for line in TABLE.read_text(encoding="utf-8").splitlines(True) if line.startswith("#"))
    body = yaml.safe_dump(record, width=10**6, allow_unicode=True, sort_keys=False, default_flow_style=None)
    TABLE.write_text(head + body, encoding="utf-8")


if __name__ == "__main__":
    main()
