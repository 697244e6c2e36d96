"""The dimension at a measured reference configuration: rank with a tolerance, second order, continuation.

`equations` scales the equations so that a singular value says by what fraction of the scene's size one can be
satisfied otherwise; `dimension` asks the criteria in the order of their cost, with the `second_order` of the dependent
equations and the `continuation` of random motions.
"""
