"""Exact expressions: what is the equation that a person wrote, and what are its derivatives?

An expression is an immutable tree of exact numbers, symbols (coordinates, velocities, parameters, time), sums,
products, powers and functions. Numbers are read as rationals; nothing here is ever a float.

Types
    `tree` defines the expression `Expr` and its constructors; `vectors` defines vectors and matrices of expressions.

Mechanisms, in the order in which an equation meets them
    1. `text` reads a formula (ASCII, Unicode, LaTeX, primes, Leibniz) into a tree, and prints a tree as a formula.
       Errors have a column and a hint. Formulas are bounded in length, depth and expanded size.
    2. `real_values` lists the conditions under which powers and functions, as they were written, have a real value, and
       keeps the numbers and powers of a text within bounds.
    3. `calculus` substitutes, writes sums as combinations of terms, differentiates, and relates differentials and
       velocities (dq = qdot dt).
    4. `rational_values` computes the rational values of roots and of trigonometric functions; `enclosures` gives every
       other constant as a certified interval.
    5. `renaming` finds expressions that are equal up to the names in them, so that work is done once for many copies,
       and defines lazy sequences of such expressions (the equations of a joint).
    6. `sympy_bridge` converts to and from SymPy, node by node and never through text.

Whether an expression is zero is decided in `dofkit.exact`, never here. Other packages receive trees, never text.
"""
