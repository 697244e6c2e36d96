"""Pictures: how does a mechanism look, how does it move, and what do its constraints allow?

Pictures read a scene and its report, and never decide anything. `still` has `draw`, `graph` and `phase`; `animation`
has `animate`. Pages (`player`) play and turn by one script of their own and fetch nothing; png, pdf, gif and mp4 need
matplotlib (`raster`), svg does not (`vector`).

From a scene to a file
    1. `arrangement` chooses where everything stands: the reference configuration, or places that satisfy the
       equations. `evaluation` computes expressions in floating point, `rates` the instantaneous motions.
    2. `stage` collects what is known before drawing, `states` what the report says of each constraint, as colours and
       words.
    3. A sketch is made of `shapes`: of a `mechanism` (with `bodies`, `symbols` of joints and `runs` of strings, gears
       and wheels), of `coordinates` without bodies (with `loci` and `fields`), of `directions` that brackets add, or
       a `constraint_graph`. `unanswered` draws a scene for the person who has to find the answer.
    4. `views` projects it; `layout` puts it on `paper` with a scale, labels, legend and title; `outlines` are hulls
       and springs; `looks` are colours that the colour-blind can tell apart, each with a pattern.
    5. `motion` makes frames; `alternative` says in words what is drawn.
"""
