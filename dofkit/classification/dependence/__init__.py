"""What follows from what: circuits, redundancy, conflicts, equivalence."""
