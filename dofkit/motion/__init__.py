"""Motion: the equations of motion of a scene, and configurations along a motion.

The question: which accelerations do energies, forces and the classified constraints imply, and which configurations
does a motion pass through? The results are a `MotionReport` and a list of configurations.

`lagrange`, in the order of a derivation
    1. `energies` reads the kinetic energy T, the potential energy V, Rayleigh's dissipation function D and the applied
       forces of a scene; `joint_motion` writes them in the angles and displacements of joints for a tree of bodies.
    2. `elimination` solves geometric equations in closed form; `model` keeps the energies and remaining constraints.
    3. `derivation` derives Lagrange's equations, and `tidying` writes them as one would by hand.
    4. `small_motions` linearizes about an equilibrium; `equations` finds cyclic coordinates and first integrals
       [Noether1918], and is the entry point `dofkit.lagrange`; `report` defines its result.
    Every equation can be rechecked by `dofkit.checker`.

Samples
    `configurations` follows a motion by arclength: `continuation` steps along the tangent space and returns to the
    configuration space by Newton's method; `poses` evaluates the relations in floating point, with quaternions for
    rotations. `loops` moves free coordinates around a closed curve. These are for pictures and samples; no verdict
    depends on them.
"""
