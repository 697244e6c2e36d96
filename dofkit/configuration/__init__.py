"""Configurations: is the set {g = 0} empty, what is its dimension, which infinitesimal motions extend to finite ones?

Types
    A `Variety` (`variety`) describes the set of a block: its dimension, generic points, a certified real point. A
    `Witness` is a certified configuration as text. A `Germ` (in `local`) is the set near one point, and
    `LocalDimension` its dimension there. A `MeasuredFreedom` is the freedom within a tolerance.

Mechanisms, in the order in which they are tried
    1. `linear_blocks` eliminates linear blocks over the rationals. `distance_geometry` proves that prescribed lengths
       are impossible [Menger1928].
    2. At a reference configuration, `at_reference` gives the instantaneous freedom by rank, and for dependent
       equations the local dimension, in the coordinates that remain after linear equations are solved. `local` decides
       it by the table `CRITERIA` in the order of cost: independent equations [ImplicitFunctions], infinitesimal
       rigidity [AsimowRoth1978], vanishing along a random curve [SchwartzZippel], second order, a branch followed in
       high precision.
    3. `measured` analyses scenes with a tolerance at the reference configuration, in floating point, with lengths in
       units of the scene's size: by the rank and its gap, the second order, continuation of motions, and the geometry
       exactly as written.
    4. Otherwise `search` computes generic points over GF(p) by solving one relation after another, and compares them
       with certified real points; `generic_dimension` gives the rank there. `components` decides whether a
       larger component exists [Krull1928]. `cases` divides a set into cases, in which a factor or a
       coefficient is 0 or not; so points of sets that are singular throughout can be found. If all real points that
       are found are singular, one is computed in high precision and analysed by `local`.

`finite_blocks` applies these to blocks of geometric equations. `rigid_motions` are the motions of the system as
one rigid body. `implied_relations` decides whether a dependent relation is implied by others near the reference
configuration. `states` are configurations together with a velocity that the constraints allow.
"""
