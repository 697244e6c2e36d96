"""The ways to answer as a table, and the doors `ask` and `derived_flag` that choose among them.

The door `classify` stands in a file of its own name, which hides a function that a room would hand on; so does `ask`.
"""
