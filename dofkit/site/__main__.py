"""`python -m dofkit.site [--out DIR]`: build the site."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from dofkit.site.building import ROOT, SiteError, build


def main() -> int:
    """Build the site and print its first page; return the exit status."""
    parser = argparse.ArgumentParser(prog="python -m dofkit.site", description="Build the documentation as a site.")
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "site", help="the folder of its pages")
    out: Path = parser.parse_args().out
    try:
        missing = build(out)
    except SiteError as error:
        sys.stderr.write(f"error: {error}\n")
        return 2
    if missing is not None:
        sys.stderr.write(f"The site is built without the bench: {missing}\n")
    sys.stdout.write(f"{out / 'index.html'}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
