"""Pictures of scenes: still, moving, as graphs, and of the directions that forms allow.

They read a scene and its report. What needs matplotlib says so; pages play and turn by a small script of their own.
"""
