"""Scenes: what did a person write, where is what is wrong with it, and which mathematics does it mean?

Types
    A `Scene` (in `scene`) is what a person wrote, validated: particles, bodies, coordinates, forces and constraints.
    A `System` (in `dofkit.system`) is its mathematics. Nothing after this room reads a scene again, and no later room
    knows from which constraint type an equation came.

Mechanisms, in the order of reading
    1. `catalog` finds the bytes; `reading` makes a `Scene` of a file, a text or a mapping and collects all faults with
       line and column. `synonyms` rewrites other words into the standard ones, `hints` say what to write instead, and
       `fields` reads exact numbers and texts and states the faults of Pydantic in English. `mending` finds the faults
       that a fault of shape hides.
    2. `parts` are points, particles, bodies, forces and energies; `constraints` has one class for each constraint
       type, with its equations, symbol and example in one file.
    3. `lowering` goes from what is written to a `System`: first `names`, then the `drawing` with its `frames`,
       then each constraint in the `world` of points and directions. `ledger` reads texts and records their faults.

Further uses: `expectation` compares a report with the `expect` of a scene, `plain` writes a scene in plain notation,
`added_equations` reads a student's equations with the scene's names, `schema` is the JSON Schema for
editors, `symbols` describes how each type is drawn, and `picture` the shapes that a scene draws itself.
"""
