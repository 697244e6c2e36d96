"""Foundations: what every room needs and what knows no mathematics.

Types
    A `Fault` (`errors`) is one thing that is wrong in what a person gave, with its location and a hint; a
    `DofkitError` carries all faults at once. A `Claim` (`verdicts`) is how certain an answer is: a verdict (proved,
    probable, numeric, undecided), the argument, the bound of its error, and the configurations that it is about.

Modules
    1. `documents` reads YAML and JSON into plain exact values, with the line and column of everything, and writes
       YAML; `yaml_events` composes them from the events of PyYAML's parser. A decimal never becomes a float.
    2. `deadline` bounds the time of a scene: long loops call `check`, which raises when the time is used up.
    3. `workers` runs jobs in processes that can be killed (`worker_process`): each job has limits of memory and time
       (`process_limits`), and a crash costs one job only. `runs` has several workers at once, here or in a cluster,
       and the journal that keeps the results of a run in one SQLite file, so that an interrupted run can be resumed.
    4. `wording` checks what is given from outside, suggests the nearest known word, chooses a format by the ending of
       a path, and puts numbers with their nouns into English.
    5. `display` is what `print` and a notebook show of a value. `libraries` imports numpy and networkx when they are
       first used.
"""

__version__ = "0.1.0"
