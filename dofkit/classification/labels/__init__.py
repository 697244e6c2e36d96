"""Labels: is a constraint holonomic, on its own and in the system, and does time occur in it?

Types
    `LabelledRow` (`entry`): a row with its label in its block. `Evidence`: all that was found of one constraint, its
    `EntryDependence` (`reasons`) on others included.
    `Traits` (from `integrability`): what a piece carries on its own.

Mechanisms, in the order in which they are tried
    1. `entries` collects the rows of every constraint with their labels, and what is known of its dependence; with all
       others forgotten a constraint is answered as a system of its own.
    2. `companions` finds a minimal set of others with which a form integrates, and the integral.
    3. `entry` joins the labels of all rows; a form with a verified integral is holonomic in any system.
    4. `reasons` states the labels of time, the claims, and one or two sentences that a student can follow.

Handed on: one entry of the report for each constraint.
"""
