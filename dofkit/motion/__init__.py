"""Motion: the equations of motion of a scene, and configurations along a motion.

`lagrange` derives Lagrange's equations of the second kind. The energies come from masses, springs, gravity or texts;
linear constraints are eliminated where that is possible, otherwise they have multipliers. It reports generalized
forces, conserved quantities (cyclic coordinates, the Jacobi integral h = sum p qdot - L), equilibria and small
motions about them, and hands the equations to SymPy. Every equation can be rechecked by `dofkit.checker`. Its
result is a `MotionReport`.

`sampled` follows a motion by arclength: a predictor along the tangent space, Newton's method back to the
configuration space. It is floating point, for pictures and for samples; no verdict rests on it.

The function `dofkit.lagrange` is the entry point of the package `lagrange`, whose modules follow the derivation:
energies, rates, elimination, equations, forces, conserved quantities, equilibria, small motions, report.
"""
