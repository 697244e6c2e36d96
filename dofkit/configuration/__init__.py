"""Configurations: is the set {g = 0} empty, what is its dimension, and which infinitesimal motions are finite?

Types
    A `Variety` (`variety`) is what is known of the set of a block: its dimension, generic points, whether a real
    point is certified. A `Witness` is a certified configuration as text. A `Germ` (in `local`) is the set near one
    point, and `LocalDimension` its dimension there. A `MeasuredFreedom` is the freedom within a tolerance.

Mechanisms, in the order in which they are tried
    1. `linear_blocks` eliminates what is linear, over the rationals. `distance_geometry` proves that lengths cannot be
       met [Menger1928].
    2. At a reference configuration, `at_reference` gives the instantaneous freedom by rank, and for dependent
       equations the local dimension, in coordinates that no linear equation gives. `local` decides it by the table
       `CRITERIA` in the order of cost: independent equations [ImplicitFunctions], infinitesimal rigidity
       [AsimowRoth1978], vanishing along a random curve [SchwartzZippel], second order, a branch continued to high
       precision.
    3. `measured` is the one numerical route for a scene with a tolerance, in lengths of the scene's size: rank with its
       gap, second order, continuation, the geometry exactly as written; otherwise undecided.
    4. Without one, `search` finds points over GF(p) by solving one relation after another (`variety`) and holds
       them against certified real points; `generic_dimension` is the rank there. `components` asks whether a larger
       component exists [Krull1928]; `cases` divides a set where a factor, or a coefficient, vanishes, which also finds
       the points of a set that is singular throughout; else one of them is brought to high precision.

`finite_blocks` puts these together for blocks of geometric equations. `rigid_motions` are the motions of the system as
one rigid body. `implied_relations` asks whether a dependent relation is implied by others near the reference
configuration. `states` are configurations together with a velocity that the constraints allow, for relations nonlinear
in the velocities.
"""
