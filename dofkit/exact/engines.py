"""The two one-sided engines, and which of them may be asked."""

from __future__ import annotations

from typing import Literal

#: ``field``: exact arithmetic at random points modulo random primes, where zero can be trusted. ``balls``: interval
#: arithmetic at real points, where non-zero is a proof.
Engine = Literal["field", "balls"]
Engines = frozenset[Engine]

FIELD: Engines = frozenset(("field",))
BALLS: Engines = frozenset(("balls",))
BOTH: Engines = FIELD | BALLS
