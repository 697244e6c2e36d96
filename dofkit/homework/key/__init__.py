"""What is known of a problem: the facts of its scene, and the numbers that known misconceptions give."""
