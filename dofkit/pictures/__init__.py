"""Pictures: how does a mechanism look, how does it move, and what do its constraints allow?

Pictures read a scene and its report, and never decide anything. `still` has `draw`, `graph` and `phase`; `animation`
has `animate`. Pages (`player`, `player.js`) play, rotate and drag by scripts of their own and fetch nothing; png,
pdf, gif and mp4 need matplotlib, svg does not (`files`).

From a scene to a file, in this order
    1. Positions: `arrangement` takes those of the reference configuration, or some that satisfy the equations, by
       Newton's method; it also has the infinitesimal motions, the null space of the Jacobian (`evaluation`). `stage`
       adds the places and sizes of symbols, `words` what the report says of each constraint.
    2. Shapes: a `Sketch` is made of `shapes` that bodies and particles carry. There are four kinds: a `mechanism`
       (with `joints`, the `loci` of equations and the `placed_shapes` of the scene's own picture, or of a disc or knife
       edge by `recognition`), the set of two or three coordinates and the directions that brackets add (both in
       `directions`), and the `constraint_graph`.
    3. Motion: frames are the same shapes with other poses. `motion_clips` has sampled finite motions (each free
       velocity in turn), infinitesimal ones, and those that are new without a constraint; `loop_clips` has loops. By
       `planar_program` and `planar.js` a page drags a planar scene. `animation` has the files.
    4. Paper: `paper` projects shapes and has their outlines, `layout` chooses the scale and where names stand, and
       adds title, legend, axes and notes; the marks are written as SVG or drawn by matplotlib.
"""
