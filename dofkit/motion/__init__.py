"""Motion: the equations of motion of a scene, and configurations along a motion.

The question: which accelerations do energies, forces and the classified constraints imply, and which configurations
does a motion pass through? The results are a `MotionReport` and a list of configurations.

`lagrange`, in the order of a derivation
    1. `energies` reads T, V, D and the applied forces of a scene; `joint_motion` gives those of a tree of bodies in
       the angles and displacements of its joints.
    2. `elimination` solves geometric equations in closed form; `model` has the energies and the remaining constraints.
    3. `derivation` has Lagrange's equations of the second kind, which `tidying` writes as on a board.
    4. `small_motions` has the linearization about an equilibrium, `equations` cyclic coordinates and first
       integrals [Noether1918] and the entry point `dofkit.lagrange`, `report` its result.
    Every equation can be rechecked by `dofkit.checker`.

Samples
    `configurations` follows a motion by arclength: `continuation` has the predictor along the tangent space and
    Newton's method back to the configuration space, `poses` the relations in floating point with quaternions for
    rotations. `loops` moves free coordinates round a closed loop. Both are for pictures and samples; no verdict rests
    on them.
"""
