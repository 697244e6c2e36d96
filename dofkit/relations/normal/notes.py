"""What is told of a relation that was read over the reals, as sentences."""

REGION_NOTE = (
    "for one sign of what stands in abs() or under the root it holds on a whole region, and takes no freedom away there"
)
NOWHERE_NOTE = "no real configuration satisfies it: it has no real value anywhere"
SQUARED_NOTE = "the root was squared away, with the sign of the other side as a condition"
COMPARED_NOTE = "both sides were squared, neither of which can be negative"
UNDONE_NOTE = "the arctangent of the velocities was undone"
QUADRATIC_NOTE = "over the reals the relation between velocities splits into linear ones"
INSTANT_NOTE = "a factor that vanishes only at instants of time was taken out"
