"""``python -m dofkit``."""

from dofkit.interface.cli import main

main()
