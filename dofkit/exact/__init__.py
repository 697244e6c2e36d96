"""Certified arithmetic: is this expression zero, what is this rank, and where is a real solution?

It knows no mechanics. Expressions become programs over independent generators, and programs are run at points.

Types
    A `Ring` (in `ring`) holds the generators and the program of some expressions. Points of several kinds (in
    `points`) run it: random ones over GF(p), rational ones, balls of real numbers, and power series along a curve.

Two engines, each of which can prove one thing (`zero` says which of them may be asked)
    1. *Field*: a random point modulo a prime. A value that is not zero there is not identically zero; one that is
       zero is identically zero but for a chance that the degree bounds [SchwartzZippel]. `residues` are its numbers.
    2. *Balls*: a real point enclosed in a ball. A value whose ball excludes zero is proved not to be zero.

Mechanisms
    `ring` writes roots, logarithms, angles and inverse functions over generators without relations between them,
    gives quotients in canonical form, and bounds their degrees; what reduces to zero there is zero, which is a proof.
    Its `quotients` brings small quotients to lowest terms and solves linear systems over polynomials.
    `zero` says whether the generators can be trusted to be independent [Ax1971], so that field and canonical form prove
    what is not zero, and asks field, canonical form and balls in turn. `analyticity` says whether a function that is
    not identically zero vanishes on no open set [IsolatedZeros].
    `triangular` draws points of a variety modulo p, solving for one of its `unknowns` after another; a search in
    floating point finds real ones, which the interval Newton test certifies [KrawczykNewton].
    `ideals` gives the dimension of a complex variety by Groebner bases [Buchberger1965], and `linear_inequalities` a
    solution of linear conditions or a proof that there is none [Motzkin1936].
    `matrices` computes ranks: modulo p, of sparse rows, of rational rows, certified ones of balls; `dense`
    has the steps and singular values of floats, by numpy only where they are many. `ring.program` has the errors by
    which arithmetic fails.

What leaves this room is a value with its certainty: a rank that is exact or bounded from one side, a zero that is
proved or probable with a bound, a point with a ball in which a true solution lies.
"""
