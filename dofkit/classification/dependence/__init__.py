"""Dependence: which constraints are implied by others, and which conflict?

Types
    `Redundancies` (from `relations`): independent equations, a maximal redundant set, groups and circuits, by the
    numbers of the constraints.

Mechanisms, in the order in which they are tried (`redundancy` is the driver)
    1. If each block removes as much freedom as it has equations, none is redundant.
    2. `circuits`: the rank of the rows over GF(p) and its circuits [Whitney1935]; `minimal_sets` enlarges
       a dependent set of rows until it implies the dependent row near the reference (`near_reference`), or at random
       states.
    3. `removal`: if dependence in a block of geometric equations is not a deficiency of the rank, constraints are
       removed; a redundant one is such that the freedom and the set stay the same.
    4. `implied_constraints`: a constraint is redundant if it is satisfied at every state of motion that the others
       allow, on all branches (`implication`, [SchwartzZippel]), and on components that random states miss
       [Rabinowitsch1929]. The module also finds minimal conflicts.

`comparison` compares multiples and gradients for `equivalence`, which tests implications in both directions.
Result: `Redundancies`, with the points for which they are valid.
"""
