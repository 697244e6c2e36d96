"""The local dimension of {g = 0} at a singular point: finite motions distinguished from infinitesimal ones.

`manifold` is the manifold M of independent relations through the point, followed along curves as power series. A `germ`
holds what criteria ask of the dependent relations on it. `criteria` is the table of criteria and its driver;
`conclusions` has a function for each row. They use the cone of second-order flexes (`quadratic_cone`), the
critical set N of the splitting lemma (`manifold`), what is true at a distance from the point (`neighbourhood`), and
`branches` of the set that are continued towards the point.
"""
