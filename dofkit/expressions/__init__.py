"""Exact expression trees, vectors of them, and the grammar in which people write and read them."""
