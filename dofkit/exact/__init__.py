"""Certified arithmetic: is this expression zero, what is this rank, and where is a real solution?

It contains no mechanics. Expressions become programs over independent generators, and programs are run at points.

Types
    A `Ring` (in `ring`) contains the generators and the program of some expressions. Points of several kinds (in
    `points`) run it: random ones over GF(p), rational ones, balls of real numbers, and power series along a curve.

Two engines, each of which can prove one thing (`zero` defines `Engine`)
    1. *Field*: a random point modulo a prime. An expression with a value that is not 0 there is not identically zero;
       one with the value 0 is identically zero, except with a probability bounded by its degree [SchwartzZippel].
       `residues` implements numbers modulo p.
    2. *Balls*: a real point enclosed in a ball. A value whose ball excludes zero is proved not to be zero.

Mechanisms
    `ring` writes roots, logarithms, angles and inverse functions over generators without relations between them, and
    gives quotients in canonical form; an expression that reduces to zero there is proved to be zero.
    Its `quotients` brings small quotients to lowest terms and solves linear systems over polynomials.
    `zero` decides whether an expression is zero: it tries field, canonical form and balls in turn. Field and canonical
    form prove that it is not zero if the generators are independent [Ax1971]. `analyticity` decides whether a function
    that is not identically zero vanishes on no open set [IsolatedZeros].
    `triangular` computes random points of a variety modulo p, solving for one of its `unknowns` after another; a search
    in floating point finds real points, which the interval Newton test certifies [KrawczykNewton].
    `ideals` gives the dimension of a complex variety by Groebner bases [Buchberger1965], and `linear_inequalities` a
    solution of linear conditions or a proof that there is none [Motzkin1936].
    `matrices` computes ranks: modulo p, of sparse rows, of rational rows (`rational`), and of balls. Its `dense`
    computes Newton steps and singular values in floating point; it imports numpy only for large matrices.
    `ring.program` defines the exceptions of arithmetic.

Every result says how certain it is: a rank is exact or a bound from one side, a zero is proved or probable with a
bound, a point comes with a ball in which a true solution lies.
"""
