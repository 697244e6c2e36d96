"""Certificates: what evidence shows that each proved claim of a report is true?

The evidence is written in the checker's own reading of the scene, and every claim is tried by the checker's rules
before it is written down, so that a certificate holds nothing that the checker refuses. Claims without evidence are
listed as uncovered; a claim whose evidence gives another value is lowered.

Types
    A `scenery.Scenery` is the checker's reading of a scene with values chosen for parameters and unknown functions. A
    `context.Context` adds the report, a main point, and rows of equations that are independent there
    (`context.Standing`).

From a report to a certificate
    1. `certificate` has a table: for each field of a report the function that yields evidence for it.
    2. `points` searches for a point by Newton's method in floats (`numerics`) and makes it exact, or a box for interval
       Newton.
    3. `freedom` writes numbers and redundancy, `dimension` what holds of all of the set and at points where rows are
       stationary, `labels` labels and integrals, `fields` velocity fields and brackets, `emptiness` contradictions
       between equations. `steps` writes what these rest on: equations that follow from others by cofactors.
    4. `lowering` says in each verdict whether it is checked, and makes a claim undecided whose evidence gives another
       value.

`motion_evidence` writes certificates of equations of motion.
"""
