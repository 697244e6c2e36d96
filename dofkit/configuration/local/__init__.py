"""The local dimension of {g = 0} at a singular point: motions told from shakes."""
