"""Foundations: helpers that all rooms (the packages of `dofkit`) use and that contain no mathematics.

Types
    A `Fault` (`errors`) is one mistake in an input, with its location and a hint; a `DofkitError` carries all faults of
    the input. A `Claim` (`verdicts`) says how certain an answer is: a verdict (proved, probable, numeric, undecided),
    the argument, a bound on its error, and the configurations for which it is true.

Modules
    1. `documents` reads YAML and JSON into plain exact values, with the line and column of everything, and writes
       YAML; `yaml_events` composes the values from the events of PyYAML's parser. A decimal never becomes a float.
    2. `deadline` limits the time spent on a scene: long loops call `check`, which raises when the time is used up.
    3. `workers` runs jobs in processes that can be killed (`worker_process`): each job has limits of memory and time
       (`process_limits`), and a crash costs one job only. `runs` runs several workers, locally or on a cluster, and
       keeps the results in a journal, one SQLite file, so that an interrupted run can be resumed.
    4. `wording` writes counts in English (1 body, 2 bodies) and suggests the nearest known word; it also checks
       arguments of public functions and chooses a format by a file extension.
    5. `display` is what `print` and a notebook show of a value. `libraries` imports numpy and networkx when they are
       first used.
"""

__version__ = "0.1.0"
