"""Equations over the reals: what does each equation say, and which equations have to be looked at together?

Types
    A `Normal` (`normal.pieces`) is the real zero set of one equation: branches of pieces, each finite (f(q, t) = 0),
    Pfaffian (a(q, t) dq + b dt = 0) or nonlinear in the velocities, with the conditions under which the equation, as
    it was written, has a value. `Reduced` has all of a constraint. A `Block` (`blocks`) has rows that share
    coordinates; an `Answer` (`answer`) is what the engines found of a block; the `Setting` (`setting`) is what they may
    assume, with the table of what need not be modelled and the reason why no answer changes.

Mechanisms, in the order in which an equation meets them
    1. `normal` finds the zero set. `zero_set` splits powers, products and sums of squares as written, and
       `polynomial_zeros` the factors of the numerator otherwise; `semidefinite` proves signs [Sylvester1852]; `domain`
       tells absolute values and roots apart by the signs of their arguments; `normal_form` splits relations quadratic
       in the velocities whose discriminant is a square. What has no such form stays as it is.
    2. `normal.no_solution` proves that equations and inequalities have no real solution, by linear conditions on their
       terms (`sign_claims`) [Motzkin1936] and by resultants, or that an inequality is satisfied somewhere, by a point.
    3. `velocity_reductions` substitutes what linear equations determine into relations nonlinear in the velocities.
    4. `blocks` separates what shares no coordinate and gives every integrated form dC = 0 its constant as a
       coordinate; `normal.pieces` recognises equations that are equal up to names; a `Chart` has the program that the
       engines run on a block. `linear_relations` solves linear and explicit equations.

Handed on: blocks, each with its program and its conditions. Nothing is dropped without a condition that says where.
"""
