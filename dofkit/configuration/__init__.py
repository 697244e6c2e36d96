"""Configurations: is the set {g = 0} empty, what is its dimension, and which infinitesimal motions are finite?

Types
    A `Variety` (`variety`) is what is known of the set of a block: its dimension, generic points, whether a real
    point is certified. A `Germ` (in `local`) is the set near one point. A `Witness` (`witness`) is a certified
    configuration as text.

Mechanisms, in the order in which they are tried
    1. `linear_blocks` and `isolated_zeros` solve what is linear, or analytic in one coordinate. `cases` divides a set
       where a factor, or a coefficient, vanishes.
    2. `search` and `generic_points` find points over GF(p) by solving one relation after another; `generic_dimension`
       is the rank there, and `components` asks whether a larger component exists.
    3. `reality` holds this against certified real points, without which a set over GF(p) says nothing;
       `singular_points` treats sets all of whose real points are singular; `distance_geometry` proves that lengths
       cannot be met.
    4. `drawing` answers at the reference configuration: the instantaneous freedom by rank, and for dependent
       equations the local dimension. `local` decides it by the table `CRITERIA` in the order of cost: independent
       equations, rigidity to first order, vanishing along a random curve, second order (stresses), a branch followed
       to high precision.
    5. `measured` is the one numerical route for a scene with a tolerance: rank with its gap, second order,
       continuation, the geometry exactly as written; otherwise undecided.
    6. `states` are configurations together with a velocity that the constraints allow, for relations nonlinear in the
       velocities.

`finite_blocks` puts these together for blocks of finite relations; `rigid_motions` are the motions of the system as
one body, and `level_bodies` the bodies whose Euler angles are singular.
`implied_relations` asks whether a dependent relation is implied by others near the reference configuration.
"""
