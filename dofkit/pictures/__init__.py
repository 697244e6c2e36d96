"""Pictures: how does a mechanism look, how does it move, and what do its constraints allow?

Pictures read a scene and its report, and never decide anything. `still` defines `draw`, `graph` and `phase`;
`animation` defines `animate`. HTML pages (`player`, `player.js`) contain the scripts that play, rotate and drag, and
load nothing; png, pdf, gif and mp4 need matplotlib, svg does not (`files`).

From a scene to a file, in this order
    1. Positions: `arrangement` takes the reference configuration, or finds positions that satisfy the equations by
       Newton's method; it also computes infinitesimal motions, the null space of the Jacobian (`evaluation`). `stage`
       adds places and sizes of symbols, and `words` the texts about the report.
    2. Shapes: a `Sketch` is made of `shapes`, whose vertices move with bodies and particles (carriers). There are four
       kinds of sketch: a `mechanism` (with `joints`, the `loci` of equations and the `placed_shapes` of the scene's own
       picture, or of a disc or knife edge by `recognition`); the configuration space of two or three coordinates, and
       the directions that constraints allow (both in `directions`); and the `constraint_graph`.
    3. Motion: frames are the same shapes with other poses. `motion_clips` makes clips of sampled finite motions (each
       free velocity in turn), infinitesimal motions, and motions that become possible without a constraint;
       `loop_clips` makes loops. `planar_program` and `planar.js` let a page drag a planar scene.
    4. Paper: `paper` projects shapes to outlines, `layout` chooses the scale and the places of names, and adds title,
       legend, axes and notes; the marks are written as SVG or drawn by matplotlib.
"""
