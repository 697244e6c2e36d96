"""Comparison of methods: how fast and how often right is each method, and where does it fail?

Types
    A `Trial` (in `trials`) is one question about a scene whose answer is known by construction. A `TrialLine`
    (`record`) is what one method answered, with its processor time. Trials that differ in size alone make a ladder. A
    `Trap` is a text of which it is hard to see whether it is 0.

From trials to charts
    1. `trials` has the families: linkages, joints, forms, identities, near-singular poses, and the catalog. Scenes
       that follow no rule stand in tables, with their truth derived by hand.
    2. `tasks` chooses some by name and lists what is to be run, with sweeps of two settings.
    3. `runner` gives every task to a worker that can be killed, and compares the answer with the truth.
    4. `record` writes the lines as CSV, so that figures can be made again without running.
    5. `statistics` has scores and Pareto fronts; `sentences` states in words what they show and why a method fails;
       `figures` draws it with matplotlib in the style of `figure_style`.

`command` is ``dofkit chart``.
"""
