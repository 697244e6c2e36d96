"""Equations over the reals: what does each equation say, and which equations have to be looked at together?

Types
    A `Normal` (in `normal`) is the real zero set of one equation: branches of pieces, each finite (f(q, t) = 0),
    Pfaffian (a(q, t) dq + b dt = 0) or nonlinear in the velocities, with the conditions under which the equation, as
    it was written, has a value. `Reduced` (`reduced`) has all of a constraint. A `Block` (`blocks`) has rows that
    share coordinates; an `Answer` (`answer`) is what the engines found of a block; the `Setting` (`setting`) is what
    they may assume.

Mechanisms, in the order in which an equation meets them
    1. `normal` finds the zero set: powers, products, sums of squares and semidefinite forms; absolute values and
       roots by the signs of their arguments; extreme values of sines and cosines; analytic functions with known
       zeros; relations quadratic in the velocities whose discriminant is a square, as linear branches. What it does
       not know stays as it is.
    2. `velocity_reductions` reduces relations nonlinear in the velocities by the linear ones.
       `integration_constants` gives every integrated form dC = 0 its constant as a coordinate.
    3. `blocks` separates what shares no coordinate; `piece_shapes` recognises equations that are equal up to names.
       `joint_equations` leaves the equations of a joint unwritten until they are needed. `reductions` is the table of
       what need not be modelled, with the reason why no answer changes.
    4. `chart` and `chart_of_block` make the program that the engines run: free coordinates, and those that equations
       give explicitly. `linear` solves linear equations over the rationals; `ambient` draws points and computes ranks
       before any equation is imposed.

Handed on: blocks, each with its program and its conditions. Nothing is dropped without a condition that says where.
"""
