"""Numbers that can be trusted: the canonical ring, points, balls, ranks, exclusion. Knows no mechanics."""
