"""Comparison of methods: how fast is each method, how often is it right, and where does it fail?

Types
    A `Trial` (in `trials`) is one question about a scene whose answer is known by construction. A `TrialLine`
    (`record`) is the answer of one method, with its processor time. Trials that differ only in size form a ladder. A
    `Trap` is an expression for which it is hard to decide whether it is 0.

From trials to charts
    1. `trials` defines the families: linkages, joints, forms, identities, near-singular poses, and the catalog.
       Irregular scenes are listed in tables, with the answers derived by hand.
    2. `tasks` selects trials by name and lists what is to be run; sweeps vary the tolerance of `numeric` and the
       precision of `balls`.
    3. `runner` gives every task to a worker that can be killed, and compares the answer with the truth.
    4. `record` writes the lines as CSV, so that figures can be made again without running.
    5. `statistics` computes scores and Pareto fronts; `sentences` states results, and why a method fails, in words;
       `figures` draws the figures with matplotlib in the style of `figure_style`.

`command` is ``dofkit chart``.
"""
