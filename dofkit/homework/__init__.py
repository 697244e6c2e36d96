"""Homework: is a student's answer right, and if not, which misconception explains it?

Types
    An `Assignment` (`assignment`) contains problems (`problem`), each with a text, a scene and questions
    (`questions`). The `Key` of a problem (`key`) contains what the report says about its scene. A `Judgement`
    (`judgement`) is the decision about one answer; a `Result` (`result`) contains the points, the feedback codes and
    how every answer was read.

From a submission to points
    1. `answers` reads files, tables, rosters and downloads of course platforms, and turns the text of an answer into a
       small set of readings (`relations`, `counts`, ...), by the question's kind and the names alone, never the key.
    2. Each question compares each reading with the key, by equivalence in the system and not as text (`key`, which
       also computes the numbers that misconceptions give), and `judgement` combines the results to one verdict.
    3. `grading` is a pure function of assignment and submission; `runs` grades many in workers that can be killed, and
       decides to which student each submission belongs.
    4. `sentences` contains the feedback in four languages. `review` collects the answers that a person must decide,
       equal answers only once. `formats` writes results for gradebooks and platforms.

`variants` gives each student a combination of values from the lecturer's lists. `starting` proposes an assignment,
`handout` typesets it, `schemas` defines the JSON Schemas of the files. `export` and `autograder` are for Gradescope,
which runs the grading. A notebook submits with `hand_in`: nothing is ever judged in a student's own process.
"""

from __future__ import annotations

from dofkit.homework.answers.submission import hand_in

__all__ = ["hand_in"]
