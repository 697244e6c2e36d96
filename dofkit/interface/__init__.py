"""The command line: files in, lines and an exit status out.

`cli` has the commands, `options` their arguments. Every command answers its files one by one in a worker that can be
killed, and no file stops those that follow.

From a command to its output
    1. `entry` starts without importing anything heavy; `help_panels` groups the help. `named_files` expands folders
       and patterns.
    2. `supervised` gives the files to a worker (one for each kind of work: `one_file`, `one_picture`,
       `one_certificate`) and prints what comes back; `many` does so for many scenes with several workers, in their
       order, and resumes an interrupted run.
    3. `classification` is the command `classify`; `conversion` has `new` and `convert`; `assignment_commands`,
       `catalog_commands` and `export_commands` have the commands of these names.
    4. `show` renders reports, motions, faults and scenes for a terminal or a page; `presentation` chooses JSON or
       text, `selection` some fields, `summary` and `outcome` tell about many scenes together.
    5. `explanations` and `field_meanings` are what `dofkit explain` knows. `streams` and `progress` are the terminal,
       and `failures` how a command ends where it cannot do what was asked.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import lazy_loader as lazy

if TYPE_CHECKING:
    from dofkit.interface.cli import main

__all__ = ["main"]


__getattr__, __dir__, _ = lazy.attach(__name__, submod_attrs={"cli": ["main"]})
