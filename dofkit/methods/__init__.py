"""Methods: the public entry points, and other ways to the same answers.

The question: how can a system move, and which of eight ways answers it, at what cost, and how certainly?

`classify` reports everything about a scene, and has `derived_flag`; `ask` answers one question with no more work than
it needs, by dofkit's engines or by any method on its own. All methods are held against these on scenes with known
answers (`dofkit chart`).

Types
    A `Method` is a row of `table`, with what it is sound for and what it costs, question by question; a `Reply` is its
    answer with its verdict.

Mechanisms, in the order in which a scene meets them
    1. `classify` has the report; with a budget it comes from a worker process that can be killed, where there are
       processes, and which first returns one in which everything is undecided.
    2. The row's engines classify the scene. A method without engines has a module of its name; of its answers the
       report of this `single_method` decides only what its own argument proves, the rest are warnings.

The methods without engines
    `count` is the textbook: f = N d - k, and the test of mixed partial derivatives. `graph` has ranks in general
    position. `exact` (rational numbers) and `numeric` (singular values) look at points; `symbolic` uses SymPy as one
    would. `as_written` reads the equations for them, and has ranks and Frobenius' test at points.

`certificates` searches for the evidence that `dofkit.checker` rechecks.
"""
