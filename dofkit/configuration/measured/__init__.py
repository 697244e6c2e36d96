"""The dimension of the set at a reference configuration with a tolerance: by rank, second order, continuation.

`equations` scales the equations such that a singular value s means: a change by s, as a fraction of the scene's size,
can make the rows dependent. It also computes the second order of dependent equations (`StressForms`). `dimension` is
the driver, with the criteria in the order of their cost; `continuation` follows random motions.
"""
