"""What is told of a relation that was read over the reals, as sentences."""

REGION_NOTE = (
    "for one sign of the argument of abs() or of the root it is satisfied on a whole region, where it does "
    "not reduce the number of degrees of freedom"
)
NOWHERE_NOTE = "no real configuration satisfies it, because it has no real value anywhere"
SQUARED_NOTE = "the root was removed by squaring, with the sign of the other side as a condition"
UNDONE_NOTE = "the arctangent of the velocities was inverted"
QUADRATIC_NOTE = "over the real numbers the relation between velocities splits into linear ones"
INSTANT_NOTE = "a factor that vanishes only at instants of time was taken out"
