"""Certified arithmetic: is this expression zero, what is this rank, and where is a real solution?

It knows no mechanics. Expressions become programs over independent generators, and programs are run at points.

Types
    A `Ring` (in `ring`) holds the generators and the program of some expressions. Points of several kinds (in
    `points`) run it: random ones over GF(p), rational ones, balls of real numbers, and power series along a curve.

Two engines, each of which can prove one thing (`engines` says which of them may be asked)
    1. *Field*: a random point modulo a prime. A value that is not zero there is not identically zero; one that is
       zero is identically zero but for a chance that the degree bounds [SchwartzZippel].
    2. *Balls*: a real point enclosed in a ball. A value whose ball excludes zero is proved not to be zero.

Mechanisms
    `ring` writes roots, logarithms, angles and inverse functions over generators without relations between them,
    gives quotients in canonical form, and bounds their degrees. `zero` decides whether a constant or an expression is
    zero, whether the generators can be trusted to be independent, and whether a function is analytic. `matrices`
    computes ranks: modulo p, of sparse rows, of rational rows, certified ones of balls, and singular values for
    measured numbers. `solving` finds points of polynomial systems modulo p, ideals [Buchberger1965], and solutions of
    linear inequalities. `boxes` excludes regions by interval arithmetic, which proves that a system has no solution.
    `errors` is the one way in which arithmetic fails.

What leaves this room is a value with its certainty: a rank that is exact or bounded from one side, a zero that is
proved or probable with a bound, a point with a ball in which a true solution lies.
"""
