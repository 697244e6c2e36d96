"""What each relation says over the reals, in blocks that share no coordinate, ready for the engines."""
