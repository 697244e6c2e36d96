"""Scenes: what did a person write, where are its mistakes, and which equations does it stand for?

Types
    A `Scene` (in `scene`) is what a person wrote, validated: particles, bodies, coordinates, forces and constraints. A
    `System` (in `dofkit.system`) is its mathematics. Later packages read the system only, and do not depend on the
    constraint type from which an equation came.

Mechanisms, in the order of reading
    1. `catalog` finds the file; `reading` makes a `Scene` of a file, a text or a mapping and collects all faults with
       line and column. `synonyms` rewrites other words into the standard ones, `hints` say what to write instead, and
       `fields` reads exact numbers and texts and states Pydantic's errors in English. `mending` removes entries with
       faults of structure, so that the faults of the other entries are found too.
    2. `parts` are points, particles, bodies, forces and energies; `constraints` has one class for each constraint
       type, with its equations, symbol and example in one file.
    3. `lowering` makes a `System` of a scene: first `names`, then the reference configuration (`drawing`, `frames`),
       then each constraint in the `world` of points and directions. `ledger` parses formulas and records their faults.

Further uses: `expectation` compares a report with the `expect` of a scene, `plain` writes a scene in plain notation,
`added_equations` reads a student's equations with the scene's names, `schema` is the JSON Schema for
editors, `symbols` describes how each type is drawn, and `picture` the shapes that a scene defines for its picture.
"""
