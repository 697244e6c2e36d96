"""``python -m dofkit``."""

from dofkit.cli import main

main()
