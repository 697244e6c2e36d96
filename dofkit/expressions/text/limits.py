"""The bounds of a text: what is beyond them is refused before anything is computed with it."""

from __future__ import annotations

MAX_CHARACTERS = 2000
#: Numbers, names and signs in one text.
MAX_NODES = 1500
MAX_DEPTH = 60
MAX_NAME = 64
#: Digits of one number, and bits of all numbers of a text together.
MAX_DIGITS = 30
MAX_TEXT_BITS = 8192
#: Constant exponents, powers of ten included, and the product of nested ones.
MAX_EXPONENT = 64
#: Bits of one number after folding.
MAX_BITS = 2048
#: An expression with more nodes than this is not differentiated while it is being read.
MAX_DIFFERENTIATED = 150
#: How often `diff` differentiates.
MAX_ORDER = 6
