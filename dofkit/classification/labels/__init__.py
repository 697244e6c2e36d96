"""Labels: is a constraint holonomic, on its own and in the system, and does time occur in it?

Types
    `LabelledRow` (`entry`): a row with its label in its block. `Evidence`: the labelled rows of one constraint, its
    answer as a system of its own, and its `EntryDependence` (`reasons`) on others.
    `Traits` (from `integrability`): labels of a piece on its own (does t occur, is the form exact?).

Mechanisms, in the order in which they are tried
    1. `entries` collects the rows of every constraint with their labels and its dependence on others; it also analyses
       the constraint as a system of its own.
    2. `companions` finds a minimal set of other constraints together with which a form is integrable, and the integral.
    3. `entry` combines the labels of all rows; a form with a verified integral is holonomic in any system.
    4. `reasons` gives the labels of time, the claims, and one or two sentences that a student can follow;
       `relation_words` has the relations of joints in words.

Result: one entry of the report for each constraint.
"""
