"""The meaning of each field of a report, and of each constraint in it."""

from __future__ import annotations

#: Of a report.
OF_REPORT: dict[str, str] = {
    "scene": "the scene's name",
    "consistent": "true if a configuration satisfies all equations at one time; false if no configuration, or no "
    "motion, does; conflicting then names a minimal set; each inequality is considered on its own",
    "feasible": "whether all inequalities can be satisfied together with the constraints; null if undecided, or if "
    "there are none",
    "infeasible": "a minimal set of constraints with inequalities that cannot be satisfied together",
    "feasible_at": "a certified point at which all inequalities are satisfied",
    "dof": "degrees of freedom: the dimension of the configuration space, which is the number of coordinates less the "
    "number of independent holonomic equations, hidden ones included; non-holonomic constraints and inequalities do "
    "not reduce it",
    "velocity_dof": "velocity freedom: the number of independent admissible velocities of finite motions; "
    "non-holonomic constraints reduce it too",
    "instantaneous_dof": "instantaneous freedom: the number of independent velocities that the constraints allow at "
    "the reference configuration",
    "singular": "true if the instantaneous freedom differs from the velocity freedom",
    "holonomic": "true if every constraint is holonomic, that is, implied by equations between coordinates (and time)",
    "scleronomic": "true if time occurs explicitly in no constraint, nor in an equation that one integrates to",
    "count": "the textbook count f = N d - k of all holonomic equations as written, and why the count is off",
    "redundant_equations": "the number of scalar equations that depend on the others",
    "redundant": "a maximal redundant set: constraints that can be removed together without changing the motion",
    "redundancies": "groups of constraints that depend on each other, and the number of dependent equations in each",
    "conflicting": "a minimal set of constraints that contradict each other",
    "generalized_coordinates": "an independent choice among the scene's coordinates, one for each degree of freedom",
    "joint_coordinates": "joint angles and displacements that describe a tree of bodies, one for each degree of "
    "freedom; null for any other scene",
    "growth_vector": "the dimensions of the distribution D of admissible directions, of D + [D, D], and so on",
    "integrable_part": "the holonomic equations that all differential constraints imply together",
    "generic": "the mobility in general position, and why the reference configuration is not generic",
    "mobility": "the mobility by the formula of Gruebler and Kutzbach, and why it differs from the true one",
    "constraints": "the constraints in order, each with its labels, its verdict and the reason",
    "forces": "the forces, and why they are no constraints",
    "special_cases": "configurations and parameter values at which the answer is another one",
    "verdict": "how certain the report is: the weakest of all its verdicts",
    "verdicts": "how certain each field is, with the argument, the bound, and the points that the claim is about",
    "witness": "a certified configuration: coordinate -> value",
    "certificate": "the evidence for what is proved, which `dofkit verify` checks",
    "method": "the method that was used",
    "modelled": "what was kept in the model, what was left out, and why",
    "warnings": "remarks, and why something is undecided",
}

#: Of a constraint's entry.
OF_CONSTRAINT: dict[str, str] = {
    "name": "as written, or c1, c2, ... by position",
    "type": "the constraint type",
    "text": "as written",
    "form": "finite, pfaffian (linear in the velocities), nonlinear (in the velocities) or inequality",
    "holonomic": "whether it is, in this system, implied by equations between coordinates (and time)",
    "holonomic_alone": "the same without all other constraints",
    "scleronomic": "whether time does not occur explicitly, nor in the equation that it integrates to (Greenwood's "
    "definition); factors that never vanish, analytic functions of t alone and declared functions are taken out "
    "first",
    "catastatic": "whether a Pfaffian form has no term in dt, or a nonlinear constraint is homogeneous in the "
    "velocities; null for any other",
    "bilateral": "false for an inequality",
    "exact": "whether the form, as written, is the differential of a function",
    "integrating_factor": "a factor that makes the form exact",
    "integral": "the equation that it integrates to, such as x*y = C",
    "circuit": "for a redundant constraint: a minimal set of earlier constraints that it is implied by",
    "equations": "the number of its scalar equations",
    "independent": "how many of them are independent of all before",
    "redundant_equations": "those that are not, in words",
    "verdict": "how certain its labels are: the weakest of their verdicts",
    "verdicts": "how certain each label is",
    "reason": "why, for a student",
}
