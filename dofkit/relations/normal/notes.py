"""What is told of a relation that was read over the reals, as sentences."""

REGION_NOTE = (
    "for one sign of what stands in abs() or under the root it holds on a whole region, and takes no freedom away there"
)
NOWHERE_NOTE = "no real configuration satisfies it: it has no real value anywhere"
SQUARED_NOTE = "the root was squared away, with the sign of the other side as a condition"
RATE_NOTE = "it holds one combination of velocities only and was solved for that: each root is linear in the velocities"
ROOTS_NOTE = (
    "it holds one combination of velocities only, which takes one of its roots: each would be a branch linear in the "
    "velocities, but they were not written down, because there are infinitely many or no formula gives them"
)
SIGNS_NOTE = "what stands in abs() may have either sign"
QUADRATIC_NOTE = "over the reals the relation between velocities splits into linear ones"
INSTANT_NOTE = "a factor that vanishes only at instants of time was taken out"
