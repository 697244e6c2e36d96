"""Integrability: which differential constraints are consequences of geometric equations, and which equations are these?

The rows of a block are one-forms: the differentials of its geometric equations and its Pfaffian forms. They span the
codistribution I, whose kernel D is the space of admissible velocities. A constraint is holonomic if its form is in
I^(inf), the last term of the derived flag of I [Frobenius1877].

Types
    A `Codistribution` (`pfaffian_system`) contains the one-forms of a block; `Traits` and `Integrability` (`traits`)
    are the labels of one form on its own; a `HolonomyLabel` is the answer for a row in the system.

Mechanisms, in the order in which they are tried
    1. `traits` gives the labels that a constraint has on its own (scleronomic, catastatic, exact), and a proof that one
       form is integrable: few variables, a closed form, w ^ dw = 0 by an identity, or a known integral.
    2. `lie_algebra` computes the Lie algebra of D along one generic curve, over GF(p) or in balls [HermannNagano], in
       power series. Its dimension is the freedom; the dimensions of D, D + [D, D], ... are the `growth_vector`.
    3. `pfaffian_system` finds hidden equations: if dt is in the span of the rows, motion is confined to a locus.
    4. `row_labels` labels every row of a block with either engine, and decides whether the reference configuration is
       exceptional. `bordered_minors` prove dependence of rows, and closure of D under brackets [Frobenius1877].
    5. `nonlinear_velocities` treats relations nonlinear in the velocities. Such a relation is non-holonomic if the set
       of admissible velocities is curved at a certified state. `rewritten_rows`: together with other constraints it
       may be equivalent to linear relations, or determine all velocities.
    6. `integrals` computes the potential and the integrating factor of one form, `first_integrals` integrals of several
       forms together; every result is proved by differentiation.
"""
