"""Equations over the reals: what is the real zero set of each, and which equations have to be analysed together?

Types
    A `Normal` (`normal.pieces`) is the real zero set of one equation: branches, each a list of pieces that are
    satisfied together. A piece is finite (f(q, t) = 0), Pfaffian (a(q, t) dq + b dt = 0), nonlinear in the velocities,
    or a condition under which the equation as written has a value. `Reduced` is a constraint with the normal forms of
    its equations. A `Row` is a piece with its constraint; a `Block` (`blocks`) is a set of rows that share coordinates;
    an `Answer` (`answer`) is the result of the engines for a block. The `Setting` (`setting`) is what they may assume.

Mechanisms, in the order in which they are applied to an equation
    1. `normal` computes the zero set. `zero_set` splits powers, products and sums of squares as written, and
       `polynomial_zeros` the factors of the numerator otherwise; `semidefinite` proves signs [Sylvester1852]; `domain`
       resolves absolute values and roots by cases; `normal_form` splits relations quadratic in the velocities whose
       discriminant is a square. An equation that has no such form is not changed.
    2. `normal.no_solution` proves that equations and inequalities have no real solution, by linear conditions on their
       terms (`sign_claims`) [Motzkin1936] and by resultants, or that an inequality is satisfied at some point.
    3. `velocity_reductions` substitutes the solutions of linear equations into relations nonlinear in the velocities.
    4. `blocks` separates rows that share no coordinate; `normal.pieces` recognises equations that are equal up to
       names; a `Chart` has the program that the engines run on a block. `linear_relations` solves linear equations.

Result: blocks. A rewritten equation carries the conditions under which it is equivalent to the original one.
"""
