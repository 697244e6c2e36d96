"""Integrability: which differential constraints are consequences of equations between coordinates, and what are these?

The rows of a block are one-forms: the differentials of its geometric equations and its Pfaffian forms. They span the
codistribution I, whose kernel D holds the admissible velocities. A constraint is holonomic where its form lies in the
last term of the derived flag of I [Frobenius1877].

Types
    A `Codistribution` (`pfaffian_system`) has the one-forms of a block; `Traits` and `Integrability` (`traits`) are
    what one form says on its own; a `HolonomyLabel` is the answer for a row in the system.

Mechanisms, in the order in which they are tried
    1. `traits` are the labels that a constraint has by its own text (scleronomic, catastatic, exact), and the proof
       that one form integrates: few variables, a closed form, w ^ dw = 0 by an identity, an integral that was found.
    2. `lie_algebra` computes the Lie algebra of D along one generic curve, over GF(p) or in balls [HermannNagano], in
       power series and dual numbers; its dimension is the freedom, those on the way are the `growth_vector`.
    3. `pfaffian_system` finds hidden equations: where dt lies in the span of the rows, motion is confined to a locus.
    4. `row_labels` labels every row of a block with either engine, and tells whether the reference configuration is
       exceptional. That rows depend on others, and that brackets stay in D, is proved by identities [Frobenius1877].
    5. `nonlinear_velocities`: what is not linear in the velocities restricts them where the fibres are curved at a
       certified state; the others may make it linear, or leave a field of lines.
    6. `integrals` has the potential and the integrating factor of one form, `first_integrals` those of several forms
       together; every result is proved by differentiation.
"""
