"""``python -m dofkit.base.workers``: one worker, over its standard input and output."""

from dofkit.base.workers.child import main

main()
