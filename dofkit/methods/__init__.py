"""Methods: the public entry points, and other ways to the same answers.

`classify` reports everything about a scene, and has `derived_flag`; `ask` answers one question with no more work than
it needs. All other methods are held against these on scenes with known answers (`dofkit chart`).

Types
    A `Method` and the traits on which it fails are rows of `table`; `names` lists the methods and the questions. A
    `Reply` is the answer to one question, with its verdict and reason.

The methods, each in a file of its name; `dispatch` asks them one by one
    `count`
        The textbook: f = N d - k, and the test of mixed partial derivatives.
    `graph`
        Ranks in general position: the pebble game for links, random places modulo a prime for joints.
    `numeric`
        Singular values above a tolerance.
    `exact`
        Rational arithmetic at one configuration.
    `symbolic`
        SymPy as one would use it. Nothing of dofkit rests on it.
    `engine`
        dofkit's engines: both, or one of them alone.
    `shared` has what several of them need: the drawing, the equations as written, replies.

Around them: `stages` gives a report in which all is undecided at once and refines it; `worker_reports` classifies in a
worker that can be killed; `unread` says what is left of a scene that could not be read; `certificates` searches for
the evidence that `dofkit.checker` rechecks.
"""
