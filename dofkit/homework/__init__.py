"""Homework: is a student's answer right, and if not, which misconception explains it?

Types
    An `Assignment` (`assignment`) has problems (`problem`, with its text) over scenes; a question is
    one of the kinds of `questions`. The `Key` of a problem (in `key`) is what the report says of its scene. A
    `Judgement` (`judgement`) is what was decided of one answer; a `Result` (`result`) has the points, the feedback
    codes and how every answer was read.

From a submission to points
    1. `answers` reads files, tables, rosters and downloads of course platforms, and turns the text of an answer into a
       small set of readings (`relations`, `counts`, ...), by the question's kind and the names alone: never by the key.
    2. Each question judges each reading against the key, by equivalence in the system and not as text (`key`, which
       also has the misconceptions with the numbers that they give), and `judgement` makes one verdict of them.
    3. `grading` is a pure function of assignment and submission; `runs` grades many in workers that can be killed and
       decides whose each submission is.
    4. `sentences` has the feedback in four languages. `review` collects what a person must decide, once for equal
       answers. `formats` writes results for gradebooks and platforms.

`variants` gives each student a combination of the lecturer's lists of values. `starting` proposes an assignment,
`handout` typesets it, `schemas` describes the files. `export` and `autograder` are for Gradescope, which grades by
itself. A notebook submits with `hand_in`: nothing is ever judged in a student's own process.
"""

from __future__ import annotations

from dofkit.homework.answers.submission import hand_in

__all__ = ["hand_in"]
