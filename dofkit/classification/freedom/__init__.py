"""Freedom: what is the dimension of the configuration space, and how many velocities are independent?

Types
    `Outcome` (`branches`): the blocks of one choice of branches, with their answers.

Mechanisms, in the order in which they are tried
    1. `preparation` computes normal forms, marks copies, and selects the branches through the reference configuration.
    2. `branches` analyses each choice of branches block by block; `isomorphic_blocks` reuses the answer for blocks that
       are equal up to names; `bridged_blocks` analyses separately the parts connected by joints that close no loop.
    3. `block` takes the cheapest sound method: counting in a graph of links, ranks over GF(p) and by balls, and for
       differential constraints the Lie algebra with the hidden equations that they imply.
    4. `common_point` searches for one configuration at one time at which every expression as written has a value,
       `velocity_domain` for a motion along which expressions in velocities have one.

Result: the outcome for the largest branch; it is undecided if another branch may be larger.
"""
