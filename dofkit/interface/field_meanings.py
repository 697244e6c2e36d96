"""What each field of a report means, and each of a constraint in it."""

from __future__ import annotations

#: Of a report.
OF_REPORT: dict[str, str] = {
    "scene": "the scene's name",
    "consistent": "false where no configuration, or no motion, satisfies all equations; conflicting then names a "
    "minimal set",
    "feasible": "whether the inequalities can all be met together with the constraints; null where undecided, or "
    "without any",
    "infeasible": "a minimal set of constraints with inequalities that cannot be met together",
    "feasible_at": "a certified point where all inequalities hold",
    "dof": "degrees of freedom: the dimension of the configuration space, coordinates less independent finite "
    "relations, hidden ones included; non-holonomic constraints and inequalities do not reduce it",
    "velocity_dof": "independent velocities of finite motions; non-holonomic constraints reduce it too",
    "instantaneous_dof": "velocities that the constraints allow to first order at the reference configuration",
    "singular": "true where more velocities are allowed to first order than belong to motions",
    "holonomic": "true where every constraint is: it follows from relations between coordinates (and time)",
    "scleronomic": "true where time enters no constraint",
    "count": "the lecture's count f = N d - k of all finite equations as written, and why it errs",
    "redundant_equations": "how many scalar equations are too many",
    "redundant": "constraints that can be dropped together without changing any motion, as many as possible",
    "redundancies": "groups of constraints that depend on each other, and how many equations each has too many",
    "conflicting": "a minimal set of constraints that contradict each other",
    "generalized_coordinates": "an independent choice among the scene's coordinates, one for each degree of freedom",
    "joint_coordinates": "of a tree of bodies that joints alone hold: angles and displacements of joints that "
    "describe it, one for each degree of freedom; null for any other",
    "growth_vector": "dimensions of the directions that differential constraints allow, then with their brackets, "
    "and so on",
    "integrable_part": "the finite relations that all differential constraints together amount to",
    "generic": "the freedom of the same joints in general position, and what is special about the drawing",
    "mobility": "the count of Gruebler and Kutzbach beside the truth, and why they differ",
    "constraints": "the constraints in order, each with its labels, its verdict and the reason",
    "forces": "forces, and why they are no constraints",
    "special_cases": "places and values of parameters where the answer is another one",
    "verdict": "how sure the report is: the weakest of all verdicts in it",
    "verdicts": "how sure each field is, by which argument, with which bound, and of which points it speaks",
    "witness": "a certified configuration: coordinate -> value",
    "certificate": "evidence of what is proved, for `dofkit verify`",
    "method": "what ran",
    "modelled": "what was computed with and what was left out, and why",
    "warnings": "what was noticed, and why something is open",
}

#: Of a constraint's entry.
OF_CONSTRAINT: dict[str, str] = {
    "name": "as written, or c1, c2, ... by position",
    "type": "the type of constraint",
    "text": "as written",
    "form": "finite, pfaffian (linear in velocities), nonlinear (in velocities) or inequality",
    "holonomic": "is it, in this system, a consequence of relations between coordinates (and time)?",
    "holonomic_alone": "the same with all other constraints forgotten",
    "scleronomic": "does time not enter?",
    "catastatic": "has a form linear in velocities no term with dt? null for any other",
    "bilateral": "false for an inequality",
    "exact": "is the form, as written, the differential of a function?",
    "integrating_factor": "what makes the form exact",
    "integral": "the finite relation that it integrates to, such as x*y = C",
    "circuit": "of a redundant one: a minimal set of constraints before it that it follows from",
    "equations": "its scalar equations",
    "independent": "how many of them do not follow from those before",
    "redundant_equations": "those that do, in words",
    "verdict": "how sure its labels are: the weakest of them",
    "verdicts": "how sure each label is",
    "reason": "why, for a student",
}
