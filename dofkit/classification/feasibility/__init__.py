"""Feasibility: can all inequalities be satisfied together with the constraints?

Types
    `Part` (`state_problem`): constraints that share coordinates with an inequality. `StateProblem`: the conditions on
    a state of motion. `Values`: a certified point. `Feasibility`: the result.

Mechanisms, in the order in which they are tried (`feasibility` is the driver)
    1. `relations.normal.sign_claims`: the inequalities contradict each other as linear conditions on their terms
       [Motzkin1936].
    2. `state_problem`: the reference configuration; a zero along slack variables that interval Newton certifies
       [KrawczykNewton].
    3. `relations.normal.no_solution`: products of inequalities, and resultants of equations.

If a proof succeeds, constraints are left out one by one until every remaining one is needed.
`regions` proves that inequalities of one side imply those of another, or finds a point that they do not share.
"""
