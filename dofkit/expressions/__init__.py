"""Exact expressions: what is the equation that a person wrote, and what are its derivatives?

An expression is an immutable tree of exact numbers, symbols (coordinates, velocities, parameters, time), sums,
products, powers and functions. Numbers are rational from the first character on; nothing here is ever a float.

Types
    `tree` has `Expr` and its constructors; `vectors` has vectors and matrices of them.

Mechanisms, in the order in which an equation meets them
    1. `text` reads the grammar (ASCII, Unicode, LaTeX, primes, Leibniz) into a tree, and prints a tree in it. Every
       error has a column and a hint. The grammar is bounded in length, depth and in the size of what a text may stand
       for.
    2. `real_values` lists the conditions under which powers and functions, as they were written, have a real value, and
       keeps the numbers and powers of a text within bounds.
    3. `calculus` substitutes, takes sums apart into linear terms, differentiates, and relates differentials and
       velocities (dq = qdot dt).
    4. `rational_values` knows the rational values of roots and of trigonometric functions; `enclosures` gives every
       other constant as a certified interval.
    5. `renaming` finds expressions that are equal up to the names in them, so that work is done once for many copies,
       and has sequences of them that are written out only when one is needed (the equations of a joint).
    6. `sympy_bridge` converts to and from SymPy, node by node and never through text.

A zero is never decided here: `dofkit.exact` does that. The rooms above receive trees, and no text.
"""
