"""The canonical ring: expressions over independent generators, and programs that evaluate them."""
