"""Models of others, each made into a scene as a person would write it: MJCF, URDF, SolveSpace sketches.

A reader takes a file's bytes and gives a `ModelDocument`: a scene's mapping, where in the file each part of it is from,
and what was not read. Nothing here knows what a scene means; `scene/` reads the mapping like any other.
"""
