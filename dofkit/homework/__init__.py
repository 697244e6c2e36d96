"""Homework: is a student's answer right, and if not, which misconception explains it?

Types
    An `Assignment` (`assignment`) has problems (`problem`, with its text in `statement`) over scenes; a question is
    one of the kinds of `questions`. The `Key` of a problem (in `key`) is what the report says of its scene. A
    `Judgement` (`judgement`) is what was found of one answer; a `Result` (`result`) has the points, the feedback
    codes and how every answer was read.

From a submission to points
    1. `answers` reads files, tables, rosters and exports of course platforms, and the words, notations and formulas
       in them.
    2. `readings` says whether and how an answer can be read, `repairs` finds what an unreadable one may mean, and
       `echo` shows students how their answers are understood, without grading them.
    3. `grading` is a pure function of assignment and submission: each question judges its answer against the key, by
       equivalence in the system and not as text; `key` also has the misconceptions with the numbers that they give.
    4. `sentences` has the feedback in four languages. `review` collects what a person must decide, once for equal
       answers.
    5. `runs` grades many submissions in workers; `formats` writes results; `item_analysis` says how each question
       did.

Variants: `variants` makes sheets of equal difficulty from a seed, `own_sheets` the one of a student, `class_sheets`
those of a roster, `sheet_owners` and `earlier_sheets` keep them stable. Writing: `starting` proposes an assignment,
`handout` typesets it, `schemas` describes the files. Platforms: `export`, `autograder`, `nbgrader`, `otter` and
`notebooks`, which both share; `stand_ins` lists answers where a platform takes numbers only.
"""
