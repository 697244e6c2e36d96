"""Joints and links: the mobility of a mechanism, judging by which bodies are joined and by where the joints are.

Types
    A connection (of a `System`) joins bodies or particles. A `Placement` gives numbers to the geometry of all
    connections; `Located` is one connection with its numbers, and `rows_of` its linear conditions on the velocities of
    its members. A `Linkage` (in `graph`) analyses a graph of rigid links in general position: redundant links, rigid
    clusters, circuits.

Mechanisms, cheapest first
    1. `counts` are f = N d - k, with d(d+1)/2 for a rigid body, and the count of Gruebler and Kutzbach
       [GrueblerKutzbach], each with the reason why it differs from the true freedom. The rank of the joint screws of a
       loop is the number of its closure conditions.
    2. `joint_tree` gives the joint coordinates of a tree of joints, and finds joints that close no loop: an open tree
       needs no equation at all.
    3. `graph` decides links in general position: the graphic matroid on a line, the (2,3) pebble game in the plane
       [Laman1970], ranks at random positions in space, where no count is sufficient.
    4. `placement` gives the connections random numbers modulo a prime, or those of the reference modulo a prime or in
       floating point; `general_position` is the mobility at random positions, and analyses blocks of links.
       `rows_at_reference` has the rows of joints there.
    5. `special_position` names what makes a geometry special: parallel or concurrent lines, points on one line, plane
       or conic [BolkerRoth1980].

Results: freedoms and redundant constraints, without writing equations; and the reasons why counts differ.
"""
