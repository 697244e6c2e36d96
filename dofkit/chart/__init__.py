"""Speed against accuracy: every method on scenes whose answers are known, and where each of them fails."""
