"""Classification: how can this system move, and what does each of its constraints do?

A `System` becomes a `Report`. What is known of a system is a `Study` (`study`); every field of the report is filled
by one row of the table `PASSES` (`passes`), by a function of `report`.

Types
    `Study`, the relations of a system in blocks with their answers; `Outcome` (in `freedom`), the answer for one
    choice of branches; `Redundancies` (in `dependence`), what depends on what; `Claim`, a verdict with its argument
    and bound.

Mechanisms, in the order in which a report is filled
    1. `freedom`: each block is answered, branch by branch, and the answers are held against one common configuration
       and time. The numbers of the largest branch count.
    2. `dependence`: circuits and redundant constraints, by the rank of rows where the rank measures dependence,
       otherwise by leaving constraints out and by implication; conflicts of an inconsistent system.
    3. `labels`: holonomic (on its own, and in the system), scleronomic, catastatic, with the sentence that gives the
       reason.
    4. `generalized_coordinates`, chosen where the rows of all others are independent; `explicit_coordinates`,
       `tangent_spaces` and `turned_coordinates` serve this choice.
    5. `feasibility`: inequalities together with the equations.
    6. `counts`: the counts that stand beside the report's own, and why they differ.
    7. `special`: loci on which a rank drops, branches of another dimension, special values of parameters.

`claims` says how certain each field is and `arguments` lists the arguments with their hypotheses; `agreements` is the
table of laws that every report is held against before it leaves; `undecided` makes a report where no time was left.
"""
