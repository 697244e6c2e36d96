"""What is told of a relation that was read over the reals, as sentences."""

REGION_NOTE = (
    "for one sign of the argument of abs() or of the root it is satisfied on a whole region, where it does "
    "not reduce the number of degrees of freedom"
)
NOWHERE_NOTE = "no real configuration satisfies it, because it has no real value anywhere"
SQUARED_NOTE = "the root was removed by squaring, with the sign of the other side as a condition"
RATE_NOTE = (
    "it contains one combination of velocities only and was solved for it: each root is linear in the velocities"
)
ROOTS_NOTE = (
    "it holds one combination of velocities only, which takes one of its roots: each would be a branch linear in the "
    "velocities, but they were not written down, because there are infinitely many or no formula gives them"
)
SIGNS_NOTE = "the argument of abs() may have either sign"
QUADRATIC_NOTE = "over the real numbers the relation between velocities splits into linear ones"
INSTANT_NOTE = "a factor that vanishes only at instants of time was taken out"
