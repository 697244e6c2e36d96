"""``python -m dofkit.workers``: one worker, over its standard input and output."""

from dofkit.workers.child import main

main()
