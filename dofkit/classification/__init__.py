"""Classification: how can this system move, and what does each of its constraints do?

A `System` becomes a `Report`. What is known of a system is a `Study` (`study`); the fields of the report are filled
by the passes of the table `PASSES` (`passes`, with the claim of each field), by functions of `study`.

Types
    `Study`, the relations of a system in blocks with their answers; `Outcome` (in `freedom`), the answer for one
    choice of branches; `Redundancies` (from `relations`), what depends on what; `Claim`, a verdict with its argument
    and bound.

Mechanisms, in the order in which a report is filled
    1. `freedom`: each block is answered, branch by branch, and the answers are held against one common configuration
       and time [ImplicitFunctions]. The numbers of the largest branch count.
    2. `dependence`: circuits and redundant constraints, by the rank of rows where the rank measures dependence
       [Whitney1935], otherwise by implication at drawn states and by removal; conflicts of an inconsistent system.
       What is asked differs, the search for a minimal set or a largest redundant one (`minimal_sets`) does not.
       `equivalence` compares an answer with the constraints that it should state.
    3. `labels`: holonomic (on its own, and in the system) [HermannNagano], scleronomic, catastatic, with the sentence
       that gives the reason.
    4. `generalized_coordinates`, chosen where the rows of all others are independent; `tangent_spaces` and
       `turned_coordinates` serve this choice.
    5. `feasibility`: inequalities together with the equations, by a certified point or a proof that there is none
       [Motzkin1936].
    6. `counts`: the counts that stand beside the report's own, and why they differ; and whether rows are dependent but
       for rounding.
    7. `special`: loci on which a rank drops or curvature vanishes, and branches of another dimension.

`arguments` lists the arguments with their hypotheses and theorems; `passes` withholds counts that contradict each
other before a report leaves; `undecided` makes a report where no time was left.
"""
