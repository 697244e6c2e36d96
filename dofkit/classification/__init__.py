"""From a `System` to a `Report`: freedom, dependence, labels with their reasons, special cases.

`study` makes a `Study` in a file of its own name, which hides a function that a room would hand on.
"""
