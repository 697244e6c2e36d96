"""Methods: the public entry points, and other ways to the same answers.

The question: how can a system move, and which of eight ways answers it, at what cost, and how certainly?

`classify` reports everything about a scene, and has `derived_flag`; `ask` answers one question with no more work than
it needs. All other methods are held against these on scenes with known answers (`dofkit chart`).

Types
    A `Method` is a row of `table`, with what it is sound for and what it costs, question by question. `reply` has the
    settings of a method (`Knobs`) and its answer (`MethodReply`); `ask` returns a `Reply` with its verdict.

Mechanisms, in the order in which a scene meets them
    1. `stages` yields a report in which everything is undecided, then the finished one; or the same from a worker
       process that can be killed.
    2. The row's engines classify the scene; a method without engines has a module of its name, and `single_reports`
       makes a report of its answers: only what its own argument proves is decided, the rest are warnings.
    3. `dispatch` asks any method one question, for the chart and for tests.

The methods without engines
    `count` is the textbook: f = N d - k, and the test of mixed partial derivatives. `graph` has ranks in general
    position. `exact` (rational numbers) and `numeric` (singular values) look at points, with what `pointwise` has for
    both; `symbolic` uses SymPy as one would. All read the equations by `as_written`.

`certificates` searches for the evidence that `dofkit.checker` rechecks.
"""
