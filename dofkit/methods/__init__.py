"""The ways to answer as a table, and the doors `classify`, `ask` and `derived_flag` that choose among them."""
