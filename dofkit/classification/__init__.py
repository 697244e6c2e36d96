"""Classification: how can this system move, and what does each of its constraints do?

A `System` becomes a `Report`. A `Study` (`study`) is a system with the results of the engines for its blocks; the
table `PASSES` (`passes`) lists the functions that fill the fields of the report, each field with its claim.

Types
    `Study`, the relations of a system in blocks with their answers; `Outcome` (in `freedom`), the answer for one
    choice of branches; `Redundancies` (from `relations`), which constraints depend on which; `Claim`, a verdict with
    its argument and bound. An answer is always the result of the engines for a block (`relations.answer.Answer`).

Mechanisms, in the order in which a report is filled
    1. `freedom`: each block is analysed, branch by branch, and a configuration and time common to all blocks is sought
       [ImplicitFunctions]. The report shows the numbers of the largest branch.
    2. `dependence`: circuits and redundant constraints, by the rank of rows if dependence is a deficiency of this rank
       [Whitney1935], otherwise by testing implication at random states and by removing constraints; conflicts of an
       inconsistent system. `minimal_sets` has the search for minimal and for largest redundant sets.
    3. `labels`: holonomic (on its own, and in the system) [HermannNagano], scleronomic, catastatic, with the sentence
       that gives the reason.
    4. `generalized_coordinates`, chosen such that the columns of the other coordinates are independent;
       `tangent_spaces` and `turned_coordinates` serve this choice.
    5. `feasibility`: inequalities together with the equations, by a certified point or a proof that there is none
       [Motzkin1936].
    6. `counts`: textbook counts shown next to the report's own numbers, and why they differ; and a warning if rows are
       dependent up to rounding.
    7. `special`: loci on which a rank drops or curvature vanishes, and branches of another dimension.

`equivalence` compares a student's answer with the constraints that it should state. `arguments` lists the arguments
with their hypotheses and theorems; `passes` withholds fields that contradict each other; `undecided` makes a report
when time has run out.
"""
