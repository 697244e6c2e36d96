"""Random points over GF(p): a nonzero expression is 0 at one with probability at most degree/p [SchwartzZippel].

Primes have 61 bits and are chosen by a hash of the program, because x^(p-1) - 1 is 0 modulo any fixed prime p; p = 1
modulo the orders of the roots of unity that occur. sin and cos of a basic angle are a random point of the unit circle;
values of exp, log, inverse and unknown functions are independent random numbers; roots are roots modulo p.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from functools import lru_cache, partial
from math import gcd, lcm, prod
from typing import Any

from flint import fmpz, fmpz_mat
from flint.utils.flint_exceptions import DomainError

from dofkit.exact.residues import residue, residue_polynomial
from dofkit.exact.ring.program import NUM, NoPointError, Scalar, Var
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex

#: Up to so many arguments are searched for linear relations; among more, only equal and opposite ones are recognised.
MOST_REDUCED = 7
#: A relation that is found is accidental with the probability 2^-SURENESS.
SURENESS = 30
#: Integer multiples of a unit are recognised up to so many times its order.
TURNS = 64
#: Largest degree of roots that a relation may require.
LARGEST = 512


class Character:
    """Values of a homomorphism (argument to exp, or angle to cos + i sin) at a point over GF(p), by argument.

    Linear relations among arguments give relations among values. ``drawn``: arguments with independent random values,
    which are related by accident only.
    """

    def __init__(self, p: int, drawn: set[int], values: dict[int, Any] | None = None) -> None:
        self.p, self.drawn = p, drawn
        self.values: dict[int, Any] = {} if values is None else values
        self._unit: tuple[Any, Any, int] | None = None

    def copy(self, drawn: set[int]) -> Character:
        """Return a character with the same values so far."""
        other = Character(self.p, drawn, dict(self.values))
        other._unit = self._unit
        return other

    def settle(self, argument: Any, root: Any, order: int) -> None:
        """Fix the value at an argument, the unit, to a root of unity of this order: 2 pi / n gives exp(2 pi i / n)."""
        self._unit = argument, root, order

    def at(self, argument: Any, draw: Callable[[], Any]) -> Any:
        """Return the value implied by those at earlier arguments, otherwise ``draw()``; may raise NoPointError."""
        u = int(argument)
        if u == 0:
            return residue(1, self.p)
        if u not in self.values:
            related = self._related(u)
            self.values[u] = draw() if related is None else related
        return self.values[u]

    def agree(self, argument: Any, value: Any) -> None:
        """Record the value at an argument; raises NoPointError if it contradicts earlier values."""
        if self.at(argument, lambda: value) != value:
            raise NoPointError("an exponential or an angle with two values at one place")

    def _related(self, u: int) -> Any | None:
        """Return the value implied by those of other arguments; None if the argument is related to none of them."""
        if u in self.drawn and self.drawn.issuperset(self.values):
            return None
        multiple = self._multiple_of_unit(u)
        if multiple is not None:
            return multiple
        if self.p - u in self.values:
            return 1 / self.values[self.p - u]
        relation = self._reduced(u) if len(self.values) <= MOST_REDUCED else None
        if relation is None:
            return None
        degree = relation.pop(u)
        if self._unit is not None and abs(degree) > 1 and int(self._unit[0]) in relation:
            raise NoPointError("an argument is a fraction of pi that is none of those written")
        settled = {**self.values} if self._unit is None else {**self.values, int(self._unit[0]): self._unit[1]}
        sign = 1 if degree > 0 else -1
        power = prod((settled[v] ** (-k * sign) for v, k in relation.items()), start=residue(1, self.p))
        return _root(power, abs(degree), self.p)

    def _multiple_of_unit(self, u: int) -> Any | None:
        """Return the value at u if u, or u minus or plus an earlier argument, is an integer multiple of the unit."""
        if self._unit is None:
            return None
        unit, root, order = self._unit
        for at, value in ((0, residue(1, self.p)), *self.values.items()):
            for other, factor in ((at, value), (-at, 1 / value)):
                k = int((residue(u, self.p) - other) / unit)
                k = k if 2 * k < self.p else k - self.p
                if abs(k) <= TURNS * order:
                    return factor * root**k
        return None

    def _reduced(self, u: int) -> dict[int, int] | None:
        """Return a short integer relation {argument: factor} of ``u`` and earlier arguments (LLL), or None."""
        args = [u, *self.values, *(() if self._unit is None else (int(self._unit[0]),))]
        n = len(args)
        most = 2.0 ** ((self.p.bit_length() - SURENESS) / n - 1)
        weight = 1 << (self.p.bit_length() + n)
        rows = [[int(i == j) for j in range(n)] + [a * weight] for i, a in enumerate(args)]
        reduced = fmpz_mat([*rows, [0] * n + [self.p * weight]]).lll()
        for i in range(reduced.nrows()):
            row = [int(reduced[i, j]) for j in range(n)]
            if int(reduced[i, n]) == 0 and 0 < abs(row[0]) <= LARGEST and max(map(abs, row)) <= most:
                return {v: k for v, k in zip(args, row, strict=True) if k}
        return None


def _root(value: Any, degree: int, p: int) -> Any:
    """Return one of the ``degree``-th roots of a value modulo p; raises NoPointError if there is none (Euler).

    The group of p - 1 elements is cyclic. With g = gcd(d, p - 1) the d-th powers are the g-th powers, and w^g = v
    implies (w^e)^d = v for d e = g modulo p - 1.
    """
    shared = gcd(degree, p - 1)
    if value ** ((p - 1) // shared) != 1:
        raise NoPointError("an argument is a fraction of others, and there is no root")
    value = min((w for w, _ in residue_polynomial([-value, *([0] * (shared - 1)), 1], p).roots()), key=int)
    return value ** pow(degree // shared, -1, (p - 1) // shared)


PRIME_BITS = 61
#: Tries for a prime modulo which the roots of numbers exist.
PRIME_TRIES = 4000

#: If pi is written: always a divisor of the circle order, the largest denominator considered, the largest order.
WHOLE_TURNS, MOST_PARTS, MOST_ORDER = 12, 360, 10**5


def circle_order(rings: Iterable[Ring]) -> int:
    """Return the common denominator D of all angles k pi/D; if pi occurs, also of those in relations like x = pi/9."""
    rings = tuple(rings)
    keys = (var.key for ring in rings for var in ring.vars if var.kind in ("cos", "sin"))
    order = lcm(1, *(denominator for angle, denominator in keys if angle == ex.PI))
    with_pi = [ring for ring in rings if {"pi", "cos"} <= {"cos" if v.kind == "sin" else v.kind for v in ring.vars}]
    for ring in with_pi:
        denominators = {part.denominator for op, part in ring.code if op == NUM}
        order = lcm(order, WHOLE_TURNS)
        for denominator in sorted(d for d in denominators if d <= MOST_PARTS):
            order = lcm(order, denominator) if lcm(order, denominator) <= MOST_ORDER else order
    return order


def number_roots(rings: Iterable[Ring]) -> tuple[tuple[int, int], ...]:
    """Return (integer, degree) of every root of an integer among the generators, sorted."""
    roots = set()
    for ring in rings:
        for var in ring.vars:
            if var.kind == "root" and isinstance(var.key[0], ex.Expr):
                roots.add((int(var.key[0].args[0]), var.degree))
    return tuple(sorted(roots))


@lru_cache(maxsize=4096)
def prime_for(order: int = 1, roots: tuple[tuple[int, int], ...] = (), seed: int | str = 0) -> int:
    """Return a random prime p = 1 modulo 8 and 2 ``order`` such that the ``roots`` exist; may raise NoPointError."""
    rng = random.Random(f"dofkit prime {order} {roots} {seed}")
    step = lcm(8, 2 * order)
    for _ in range(PRIME_TRIES):
        p = step * (rng.getrandbits(PRIME_BITS) // step) + 1
        if p.bit_length() < PRIME_BITS - 1 or not fmpz(p).is_probable_prime():
            continue
        if all(pow(value, (p - 1) // gcd(degree, p - 1), p) == 1 for value, degree in roots):
            return p
    raise NoPointError("no prime has all the roots of numbers that occur")


class FieldPoint:
    """Values in GF(p) of generators; a value that was not `set` is chosen at random when first needed, and kept."""

    def __init__(self, p: int, rng: random.Random, order: int = 1) -> None:
        self.p = p
        self.rng = rng
        self.order = order
        self.values: dict[tuple[str, object], Scalar] = {}
        self._taken: dict[tuple[object, ...], Scalar] = {}
        self._drawn: set[int] = set()
        self._exponentials, self._turns = Character(p, self._drawn), Character(p, self._drawn)
        self._agreed: set[tuple[str, object]] = set()
        self._zeta: Scalar = None
        self._imaginary: Scalar = None

    def set(self, var: Var, value: Scalar) -> None:
        """Give a generator its value."""
        self.values[var.kind, var.key] = value
        if var.kind == "pi":  # angles that come out as multiples of pi / D have the values of these
            self._setup_unity()
            self._turns.settle(value / self.order, self._zeta, 2 * self.order)

    def copy(self) -> FieldPoint:
        """Return a point with the same values so far; values chosen later differ."""
        other = FieldPoint(self.p, self.rng, self.order)
        other.values = dict(self.values)
        other._taken, other._agreed = dict(self._taken), set(self._agreed)
        other._drawn = set(self._drawn)
        other._exponentials, other._turns = self._exponentials.copy(other._drawn), self._turns.copy(other._drawn)
        other._zeta, other._imaginary = self._zeta, self._imaginary
        return other

    def number(self, value: Fraction) -> Scalar:
        if value.denominator == 1:
            return residue(value.numerator, self.p)
        return residue(value.numerator, self.p) / residue(value.denominator, self.p)

    def random(self) -> Scalar:
        return residue(self.rng.randrange(2, self.p), self.p)

    def generator(self, var: Var, args: Sequence[Scalar]) -> Scalar:
        name = (var.kind, var.key)
        value = self.values.get(name)
        if value is None:
            value = self.values[name] = self._draw(var, args)
        elif args and name not in self._agreed:
            self._agreed.add(name)
            self._agree(var, args, value)
        return value

    def whatever(self, var: Var) -> Scalar:
        """Return the value of a generator before its arguments have values; `generator` compares it with them later."""
        name = (var.kind, var.key)
        if name not in self.values and var.kind in ("cos", "sin"):
            self._setup_unity()
            self._set_angle(var, self._turn())
        elif name not in self.values:
            self.values[name] = self._sign() if var.kind == "sign" else self.random()
        return self.values[name]

    def _agree(self, var: Var, args: Sequence[Scalar], value: Scalar) -> None:
        """Raise NoPointError if the function has another value than ``value`` at equal arguments; else record it."""
        if var.kind == "exp":
            self._exponentials.agree(args[0], value)
        elif var.kind in ("cos", "sin"):
            if var.key[0] != ex.PI and ("sin" if var.kind == "cos" else "cos", var.key) in self.values:
                self._setup_unity()
                cos, sin = self.values["cos", var.key], self.values["sin", var.key]
                self._turns.agree(args[0], cos + self._imaginary * sin)
        elif self._of_arguments(var, args, lambda: value) != value:
            raise NoPointError("a function with two values at one place")

    def _of_arguments(self, var: Var, args: Sequence[Scalar], draw: Callable[[], Scalar]) -> Scalar:
        """Return the earlier value of this function at equal arguments, or else ``draw()``.

        At this point differently written arguments a and b may be equal, and then f(a) = f(b).
        """
        head = var.key[:2] if var.kind == "call" else ()
        key = (var.kind, *head, var.degree, *map(int, args))
        if key not in self._taken:
            self._taken[key] = draw()
        return self._taken[key]

    def _draw(self, var: Var, args: Sequence[Scalar]) -> Scalar:
        """Return a random value for a generator; recorded here for pi, angles and functions with equal arguments."""
        if var.kind in ("cos", "sin"):
            self._draw_angle(var, args)
            return self.values[var.kind, var.key]
        if var.kind == "exp" and args:
            return self._exponentials.at(args[0], self.random)
        if args:
            return self._of_arguments(var, args, partial(self._draw_value, var, args))
        value = self.random()
        if var.kind == "symbol":
            self._drawn.add(int(value))
        if var.kind == "pi":
            self.set(var, value)
        return value

    def _draw_value(self, var: Var, args: Sequence[Scalar]) -> Scalar:
        """Return a value of a root, sign or other function; functions that vanish at 0 get the value 0 there."""
        if var.kind == "root":
            return self._root(var, args[0])
        if var.kind == "sign":
            return self._sign()
        if var.kind != "call" and args[0] == 0:
            return residue(0, self.p)
        return self.random()

    def _draw_angle(self, var: Var, args: Sequence[Scalar]) -> None:
        """Set cosine and sine of an angle: by a root of unity for pi/D, otherwise at random."""
        angle, denominator = var.key
        if angle == ex.PI:
            cos, sin = self._cos_and_sin(denominator)
        elif args[0] == 0:
            cos, sin = residue(1, self.p), residue(0, self.p)
        else:
            self._setup_unity()
            self._set_angle(var, self._turns.at(args[0], self._turn))
            return
        self.values["cos", var.key] = cos
        self.values["sin", var.key] = sin

    def _set_angle(self, var: Var, z: Scalar) -> None:
        """Set cosine and sine of an angle from z = cos + i sin."""
        self.values["cos", var.key] = (z + 1 / z) / 2
        self.values["sin", var.key] = (z - 1 / z) / (2 * self._imaginary)

    def _sign(self) -> Scalar:
        return residue(self.rng.choice((1, -1)), self.p)

    def _turn(self) -> Scalar:
        """Return z = cos + i sin of a random angle, as (1 + i w) / (1 - i w) with a random w."""
        w = self._imaginary * self.random()
        return (1 + w) / (1 - w)

    def _setup_unity(self) -> None:
        """Set, once, a primitive root of unity for exp(pi i / order), and i, a root of -1."""
        if self._zeta is None:
            n = lcm(4, 2 * self.order)
            factors = [int(q) for q, _ in fmpz(n).factor()]
            while True:
                zeta = self.random() ** (self.p // n)  # n divides p - 1
                if all(zeta ** (n // q) != 1 for q in factors):
                    break
            self._zeta = zeta ** (n // (2 * self.order))  # exp(pi i / order)
            self._imaginary = zeta ** (n // 4)

    def _cos_and_sin(self, denominator: int) -> tuple[Scalar, Scalar]:
        """Return cos and sin of pi/denominator, from powers of one primitive root of unity."""
        self._setup_unity()
        zeta = self._zeta ** (self.order // denominator)
        inverse = 1 / zeta
        return (zeta + inverse) / 2, (zeta - inverse) / (2 * self._imaginary)

    def _root(self, var: Var, value: Scalar) -> Scalar:
        """Return a random one of the roots of ``value`` modulo p; raises NoPointError if there is none."""
        if isinstance(var.key[0], ex.Expr) and var.degree == 2:
            cyclotomic = self._root_in_circle(int(var.key[0].args[0]))
            if cyclotomic is not None:
                return cyclotomic
        if var.degree == 2:
            try:
                root = value.sqrt()
            except DomainError as error:
                raise NoPointError("no square root") from error
            return self.rng.choice((root, -root))
        roots = residue_polynomial([-value, *([0] * (var.degree - 1)), 1], self.p).roots()
        if not roots:
            raise NoPointError("no root")
        return self.rng.choice(roots)[0]

    def _root_in_circle(self, prime: int) -> Scalar | None:
        """Return sqrt(prime) as a sum of the roots of unity (Gauss sum [GaussSum]); None if they do not contain it."""
        if prime == 2 and self.order % 4 == 0:
            self._setup_unity()
            eighth = self._zeta ** (self.order // 4)
            return eighth + 1 / eighth
        if prime < 3 or self.order % prime:
            return None
        self._setup_unity()
        zeta = self._zeta ** (2 * self.order // prime)
        total = residue(0, self.p)
        for a in range(1, prime):
            total += zeta**a if pow(a, (prime - 1) // 2, prime) == 1 else -(zeta**a)
        return total if prime % 4 == 1 else total / self._imaginary


def field_point(rings: Sequence[Ring], seed: int, salt: str = "") -> FieldPoint:
    """Return a new random point for programs that share their symbols, modulo one of three primes (by ``seed``).

    Primes and values depend on a hash of the programs and on ``salt``, so that no scene can be written with
    coefficients that vanish modulo the primes in use.
    """
    order, roots, digests = circle_order(rings), number_roots(rings), " ".join((*(ring.digest for ring in rings), salt))
    p = prime_for(order, roots, f"{seed % 3} {digests}")
    return FieldPoint(p, random.Random(f"dofkit point {seed} {digests}"), order)
