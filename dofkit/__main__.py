"""``python -m dofkit``."""

from dofkit.interface.entry import main

main()
