"""Numbers that can be trusted: expressions over finite fields and balls, points, ranks."""
