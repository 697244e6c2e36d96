"""The set {g = 0}: is it empty, its generic points, its dimension, and what can move at the drawing."""
