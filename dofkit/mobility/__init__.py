"""Joints and links: how mobile is a mechanism by who is joined to whom, and by where the joints are?

Types
    A connection (of a `System`) joins bodies or particles. A `Placement` gives every connection numbers; `Located` is
    one of them, and `rows_of` the linear conditions that it puts on the velocities of what it joins. A `Linkage` (in
    `graph`) answers for a graph of rigid links in general position: redundant links, rigid clusters, circuits.

Mechanisms, cheapest first
    1. `counts` are f = N d - k, with d(d+1)/2 for a rigid body, and the count of Gruebler and Kutzbach
       [GrueblerKutzbach], each with the reason why it is off; a loop's screws say by how many conditions it closes.
    2. `joint_tree` has the joint coordinates of a tree of joints, and finds joints that close no loop: an open tree
       needs no equation at all.
    3. `graph` decides links in general position: the graphic matroid on a line, the (2,3) pebble game in the plane
       [Laman1970], ranks at random positions in space, where no count suffices.
    4. `placement` puts the same connections at random places modulo a prime, at the reference, or in floating point;
       `general_position` is the mobility at random places, and answers blocks that are graphs of links.
    5. `special_position` names what makes a geometry special: parallel or concurrent lines, points on one line, plane
       or conic [BolkerRoth1980].

Handed on: freedoms and redundant constraints that need no equation, and for all others the reason why the counts
differ.
"""
