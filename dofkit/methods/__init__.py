"""Methods: the public entry points, and other ways to the same answers.

The question: how can a system move, and which of the eight methods answers it, at what cost, and how certainly?

`classify` reports everything about a scene (its module also defines `derived_flag`); `ask` answers one question with no
more work than needed, by dofkit's engines or by one method on its own. `dofkit chart` compares all methods on scenes
with known answers.

Types
    A `Method` is a row of `table`: for each question, when the method is sound and what it costs. A `Reply` is the
    answer to a question, with its verdict.

Mechanisms, in the order in which they are applied
    1. `classify` makes the report. With a time budget a worker process makes it, and first returns a report in which
       everything is undecided, in case it has to be killed. (In a browser there are no processes.)
    2. The methods `auto`, `field` and `balls` are dofkit's engines (both, exact arithmetic, ball arithmetic); any other
       method has a module of its name; `single_method` turns its answers into a report: fields for those that its own
       argument proves, warnings for the others.

The methods without engines
    `count` is the textbook count f = N d - k with the test of mixed partial derivatives. `graph` computes ranks in
    general position. `exact` (rational numbers) and `numeric` (singular values) work at points; `symbolic` uses SymPy
    directly. `as_written` reads the equations for these, and computes ranks and Frobenius' test at points.

`certificates` searches for the evidence that `dofkit.checker` rechecks; `verify` has it rechecked.
"""
