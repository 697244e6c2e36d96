"""The key of a problem: facts about its scene, and the numbers that known misconceptions give."""
