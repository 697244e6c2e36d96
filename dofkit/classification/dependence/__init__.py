"""Dependence: which constraints are implied by others, which conflict, and are two sets of equations equivalent?

Types
    `Redundancies` (from `relations`): independent equations, a maximal redundant set, groups and circuits, by the
    numbers of the constraints. `Sameness` (`equivalence`): how a student's answer compares with the wanted constraints.

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

`equivalence` tests implications in both directions; `comparison` compares multiples, inequalities and gradients.
Result: `Redundancies`, with the points for which they are valid.
"""
