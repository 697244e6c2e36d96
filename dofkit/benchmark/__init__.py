"""Comparison of methods: how fast and how often right is each method, and where does it fail?

Types
    A `Trial` (in `trials`) is one question about a scene whose answer is known by construction. A `TrialLine`
    (`record`) is what one method answered, right, wrong or undecided, with its processor time.

From trials to charts
    1. `trials` has the families: linkages, joints, forms, identities, near-singular poses, and the catalog;
       `selecting` picks some by name, `tasks` lists what is to be run, with sweeps of tolerance, digits and size.
    2. `runner` gives every task to a worker that can be killed; `trial_job` is what the worker does; `judging`
       compares.
    3. `storing` writes the lines as CSV, so that figures can be made again without running.
    4. `statistics` has scores, Pareto fronts and growth; `summary` and `sentences` say in words what they show,
       `failures` why a method fails; `table` prints it, `figures` draws it with matplotlib.

`command` is ``dofkit chart``. `ablation` measures what each reduction of the model is worth.
"""
