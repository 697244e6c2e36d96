"""The local dimension of {g = 0} at a singular point: finite motions distinguished from infinitesimal ones.

`manifold` computes curves, as power series, on the manifold M of independent relations through the point. A `germ`
computes what the criteria use of the dependent relations on M, when first needed. `criteria` is the table of criteria
and its driver; `conclusions` has a function for each row. They use the cone of second-order flexes (`quadratic_cone`),
the critical set N of the splitting lemma (`manifold`), points at a distance (`neighbourhood`), and `branches` of the
set that are followed towards the point.
"""
