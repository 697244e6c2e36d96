"""Freedom: what is the dimension of the configuration space, and how many velocities are independent?

Types
    `Outcome` (`branches`): the blocks of one choice of branches, with their answers.

Mechanisms, in the order in which they are tried
    1. `preparation` reduces every relation, marks copies, and keeps the branches through the reference configuration.
    2. `branches` answers each choice of branches block by block; `isomorphic_blocks` answers equal blocks once, and
       `bridged_blocks` answers apart what joints without loops hold together.
    3. `block` takes the cheapest sound method: counting in a graph of links, ranks over GF(p) and by balls, and for
       differential constraints the Lie algebra with the hidden equations that they force.
    4. `common_point` asks for one configuration at one time at which every expression has a value as it was written,
       and for velocities by which a quotient can divide.

Handed on: the largest outcome; it is undecided where another branch may be larger.
"""
