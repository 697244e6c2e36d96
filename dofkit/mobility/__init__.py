"""Joints and links: how mobile is a mechanism by who is joined to whom, and by where the joints are?

Types
    A connection (of a `System`) joins bodies or particles. A `Linkage` (in `graph`) answers for a graph of rigid
    links in general position: redundant links, rigid clusters, circuits. `twists` has the linear conditions that a
    connection puts on the twists of the bodies that it joins.

Mechanisms, cheapest first
    1. `textbook_count` is f = N d - k, with d(d+1)/2 for a rigid body, and the reason why it is off; `kutzbach` is
       the count of Gruebler and Kutzbach, with the screws that a loop spans.
    2. `bridges` finds joints that close no loop, and `joint_tree` the joint coordinates of a tree: an open tree needs
       no equation at all. `tree_pose` moves it to a pose without singular angles, to choose coordinates.
    3. `graph` decides links in general position: the graphic matroid on a line, the (2,3) pebble game in the plane
       [Laman1970], ranks at random positions in space, where no count suffices. `frameworks` uses it for the blocks
       of a scene.
    4. `placement` puts the same connections at random places modulo a prime; `general_position` is the mobility
       there.
    5. `rows_at_drawing` writes the rows of joints at the reference configuration from their geometry, and
       `rank_at_drawing` answers where the rank of these rows already decides.
    6. `special_position` names what makes a geometry special: parallel or concurrent lines, points on one line, plane
       or conic. `near_dependence` warns of rows that are dependent but for rounding.

Handed on: freedoms and redundant constraints that need no equation, and for all others the reason why the counts
differ.
"""
