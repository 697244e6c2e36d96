"""Scenes: what did a person write, where is what is wrong with it, and which mathematics does it mean?

Types
    A `Scene` (in `scene`) is what a person wrote, validated: particles, bodies, coordinates, forces and constraints.
    A `System` (in `dofkit.system`) is its mathematics. Nothing after this room reads a scene again, and no later room
    knows from which constraint type an equation came.

Mechanisms, in the order of reading
    1. `found_files` and `catalog` find the bytes; `reading` makes a `Scene` of a file, a text or a mapping and
       collects all faults with line and column. `synonyms` rewrites other words into the standard ones, `hints` and
       `corrections` say what to write instead, `tagged_union` reports a missing or unknown `type`, and `fields` reads
       exact numbers and texts.
    2. `parts` are points, particles, bodies, forces and energies; `constraints` has one class for each constraint
       type, with its equations, symbol, variants and example in one file.
    3. `survey` goes from what is written to what is known: `names`, then the `drawing` with its `frames`, then
       `elaboration` of each constraint in the `world` of points and directions. `ledger` reads texts and records
       their faults; `carriers` warns of joints that mean something else than they seem to.
    4. `reference` fixes the reference configuration; `lowering` writes the `System`. `joint_geometry` keeps the
       geometry of a joint whose equations are not written out.

Further uses: `expectation` compares a report with the `expect` of a scene, `dropped` leaves constraints out,
`variation` makes variants of equal difficulty, `added_equations` reads a student's equations with the scene's names,
`schema` is the JSON Schema for editors, and `symbols` describes how each type is drawn.
"""
