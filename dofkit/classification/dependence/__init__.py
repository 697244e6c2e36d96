"""Dependence: which constraints are implied by others, which conflict, and is one set of equations the same as another?

Types
    `Redundancies` (from `relations`): independent equations, a maximal redundant set, groups and circuits, by the
    numbers of the constraints. `Sameness` (`equivalence`): how an answer compares with the constraints asked for.

Mechanisms, in the order in which they are tried (`redundancy` is the driver)
    1. Each block removes as much freedom as it has equations: none is redundant.
    2. `circuits`: the rank of the rows over GF(p) and its circuits [Whitney1935]; `minimal_sets` enlarges
       a dependent set of rows until it implies the dependent one near the reference, or at drawn states.
    3. `removal`: constraints are left out of a finite block whose rank does not measure dependence; the freedom and the
       set must stay the same.
    4. `implied_constraints`: a constraint is redundant if it is satisfied at every state of motion that the others
       allow, on all branches (`implication`, [SchwartzZippel]), and on components that drawn states miss
       [Rabinowitsch1929]; it also finds minimal conflicts.

`equivalence` asks `implication` in both directions; `comparison` has its shorter ways, inequalities and gradients.
Handed on: `Redundancies`, with the points for which they are valid.
"""
