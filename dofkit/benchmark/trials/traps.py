"""Expressions that are zero by an identity and do not look it, and near misses of each.

``zero`` vanishes identically where it is defined; each of ``misses`` differs from it by a constant that is not 0, or
by a sign, and is zero at single points at most. ``w`` and ``v`` are real coordinates, ``a`` and ``b`` positive
parameters.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Trap:
    """``never``: those near misses that vanish nowhere, so that setting them to 0 is a contradiction."""

    name: str
    zero: str
    sign: str | None = None
    names: str = ""
    never: bool = True

    @property
    def tiny(self) -> tuple[str, ...]:
        """The identity missed by constants that floating point does not see."""
        return tuple(f"{self.zero} + {e}" for e in ("1e-9", "1e-25"))

    @property
    def misses(self) -> tuple[str, ...]:
        return (*self.tiny, *((self.sign,) if self.sign else ()))

    @property
    def everywhere(self) -> bool:
        """Has it a value wherever the coordinates are? Else a relation with it in says more than that it is zero."""
        return not self.coordinates or not any(f"{name}(" in self.zero for name in ("log", "asin", "acos"))

    @property
    def coordinates(self) -> list[str]:
        return [name for name in self.names if name in "wv"]

    @property
    def parameters(self) -> list[str]:
        return [name for name in self.names if name in "ab"]


#: Numbers: name, zero, with another sign.
NUMBERS = [
    ("nested root of 6", "sqrt(5+2*sqrt(6)) - sqrt(2) - sqrt(3)", "sqrt(5+2*sqrt(6)) - sqrt(2) + sqrt(3)"),
    ("nested root of 2", "sqrt(3+2*sqrt(2)) - 1 - sqrt(2)", "sqrt(3-2*sqrt(2)) - 1 - sqrt(2)"),
    ("nested root of a difference", "sqrt(11-6*sqrt(2)) - 3 + sqrt(2)", "sqrt(11-6*sqrt(2)) + 3 - sqrt(2)"),
    ("nested root of 3", "sqrt(2+sqrt(3)) - (sqrt(6)+sqrt(2))/2", "sqrt(2+sqrt(3)) - (sqrt(6)-sqrt(2))/2"),
    ("root in a root", "sqrt(sqrt(2)*sqrt(8)) - 2", "sqrt(sqrt(2)*sqrt(8)) + 2"),
    ("cubic root of 5", "(2+sqrt(5))^(1/3) - (1+sqrt(5))/2", "(2+sqrt(5))^(1/3) - (1-sqrt(5))/2"),
    ("cubic root of 2", "(7+5*sqrt(2))^(1/3) - 1 - sqrt(2)", "(7+5*sqrt(2))^(1/3) + 1 - sqrt(2)"),
    ("two cubic roots", "(2+sqrt(5))^(1/3) - (sqrt(5)-2)^(1/3) - 1", "(2+sqrt(5))^(1/3) + (sqrt(5)-2)^(1/3) - 1"),
    ("a product of roots", "sqrt(2)*sqrt(3) - sqrt(6)", "sqrt(2)*sqrt(3) + sqrt(6)"),
    ("a golden cosine", "cos(pi/5) - (1+sqrt(5))/4", "cos(pi/5) - (1-sqrt(5))/4"),
    ("a golden sine", "sin(pi/10) - (sqrt(5)-1)/4", "sin(pi/10) - (sqrt(5)+1)/4"),
    ("sine of 15 degrees", "sin(pi/12) - (sqrt(6)-sqrt(2))/4", "sin(pi/12) - (sqrt(6)+sqrt(2))/4"),
    ("cosines of sevenths", "cos(pi/7) - cos(2*pi/7) + cos(3*pi/7) - 1/2", "cos(pi/7) + cos(3*pi/7) - 1/2"),
    ("tangent of 22.5 degrees", "tan(pi/8) - sqrt(2) + 1", "tan(pi/8) - sqrt(2) - 1"),
    ("arc tangent of 1", "atan(1) - pi/4", "atan(1) + pi/4"),
    ("arc tangent of a root", "atan(sqrt(3)) - pi/3", "atan(-sqrt(3)) - pi/3"),
    ("arc tangent of 2 - root 3", "atan(2-sqrt(3)) - pi/12", "atan(2+sqrt(3)) - pi/12"),
    ("Euler's arc tangents", "atan(1/2) + atan(1/3) - pi/4", "atan(1/2) - atan(1/3) - pi/4"),
    ("Machin's arc tangents", "4*atan(1/5) - atan(1/239) - pi/4", "4*atan(1/5) + atan(1/239) - pi/4"),
    ("arc sine of a half", "asin(1/2) - pi/6", "asin(-1/2) - pi/6"),
    ("arc cosine of a half", "acos(1/2) - pi/3", "acos(-1/2) - pi/3"),
    ("arc cosine of minus a half", "acos(-1/2) - 2*pi/3", "acos(1/2) - 2*pi/3"),
    ("arc sine of a root", "asin(sqrt(2)/2) - pi/4", "asin(sqrt(2)/2) + pi/4"),
    ("a golden arc sine", "asin((sqrt(5)-1)/4) - pi/10", "asin((1-sqrt(5))/4) - pi/10"),
    ("two arc sines", "asin(3/5) + asin(4/5) - pi/2", "asin(3/5) - asin(4/5) - pi/2"),
    ("twice an arc sine", "2*asin(3/5) - asin(24/25)", "2*asin(3/5) + asin(24/25)"),
    ("arc tangent of two numbers", "atan2(1,-1) - 3*pi/4", "atan2(-1,-1) - 3*pi/4"),
    ("arc tangent of a half turn", "atan2(0,-1) - pi", "atan2(0,1) - pi"),
    ("exp of log", "exp(log(3)) - 3", "exp(-log(3)) - 3"),
    ("half a logarithm", "exp(log(2)/2) - sqrt(2)", "exp(-log(2)/2) - sqrt(2)"),
    ("log of a product", "log(6) - log(2) - log(3)", "log(6) - log(2) + log(3)"),
    ("log of a root", "log(sqrt(2)) - log(2)/2", "log(sqrt(2)) + log(2)/2"),
    ("logs of conjugates", "log(2+sqrt(3)) + log(2-sqrt(3))", "log(2+sqrt(3)) - log(2-sqrt(3))"),
    ("exponentials of numbers", "exp(2)*exp(-2) - 1", "exp(2)*exp(2) - 1"),
    ("powers of E", "E^2 - exp(2)", "E^-2 - exp(2)"),
    ("hyperbolic sine of 1", "sinh(1) - (E - 1/E)/2", "sinh(1) - (E + 1/E)/2"),
    ("decimals", "0.1 + 0.2 - 0.3", "0.1 - 0.2 - 0.3"),
    ("1e-12 and 1e9", "1e-12*1e9*1000 - 1", "1e-12*1e9*1000 + 1"),
    ("root of 1e-24", "sqrt(1e-24)*1e12 - 1", "sqrt(1e-24)*1e12 + 1"),
]  # fmt: skip

#: Functions of coordinates: name, zero, with another sign, the coordinates and parameters in it, no real zero of that?
FUNCTIONS = [
    ("abs against root", "abs(w) - sqrt(w^2)", "abs(w) + sqrt(w^2) + 1", "w"),
    ("abs squared", "abs(w)^2 - w^2", "abs(w)^2 + w^2 + 1", "w"),
    ("abs of minus", "abs(-w) - abs(w)", "abs(-w) + abs(w) + 1", "w"),
    ("abs of a product", "abs(w*v) - abs(w)*abs(v)", "abs(w*v) + abs(w)*abs(v) + 1", "wv"),
    ("root of a square of a sum", "sqrt(w^2+2*w*v+v^2) - abs(w+v)", "sqrt(w^2+2*w*v+v^2) + abs(w+v) + 1", "wv"),
    ("root of a fourth power", "sqrt(w^4) - w^2", "sqrt(w^4) + w^2 + 1", "w"),
    ("root of a perfect square", "sqrt(1+2*w^2+w^4) - 1 - w^2", "sqrt(1+2*w^2+w^4) + 1 + w^2", "w"),
    ("power 3/2 of a square", "(w^2)^(3/2) - abs(w)^3", "(w^2)^(3/2) + abs(w)^3 + 1", "w"),
    ("Pythagoras", "sin(w)^2 + cos(w)^2 - 1", "sin(w)^2 + cos(w)^2 + 1", "w"),
    ("hyperbolic Pythagoras", "cosh(w)^2 - sinh(w)^2 - 1", "cosh(w)^2 + sinh(w)^2 + 1", "w"),
    ("tangent of twice", "tan(2*w) - 2*tan(w)/(1-tan(w)^2)", None, "w"),
    ("sine of thrice", "sin(3*w) - 3*sin(w) + 4*sin(w)^3", "sin(3*w) - 3*sin(w) + 4*sin(w)^3 + 9", "w"),
    ("sine of a sum", "sin(w+v) - sin(w)*cos(v) - cos(w)*sin(v)", None, "wv"),
    ("half an angle", "2*sin(w/2)^2 + cos(w) - 1", "2*sin(w/2)^2 + cos(w) + 1", "w"),
    ("hyperbolic tangent", "tanh(w) - (exp(2*w)-1)/(exp(2*w)+1)", "tanh(w)^2 + (exp(2*w)+1)", "w"),
    ("sine of arc sine", "sin(asin(w)) - w", "sin(asin(w)) - w + 3", "w"),
    ("cosine of arc sine", "cos(asin(w)) - sqrt(1-w^2)", "cos(asin(w)) + sqrt(1-w^2) + 1", "w"),
    ("tangent of arc tangent", "tan(atan(w)) - w", "tan(atan(w)) - w + 1", "w"),
    ("cosine of arc cosine", "cos(acos(w)) - w", "cos(acos(w)) - w + 1", "w"),
    ("sine of arc tangent", "sin(atan(w)) - w/sqrt(1+w^2)", "cos(atan(w)) + 1/sqrt(1+w^2)", "w"),
    ("arc sine and arc cosine", "asin(w) + acos(w) - pi/2", "asin(w) + acos(w) + pi/2", "w"),
    ("arc sines by abs", "acos(1-2*w^2) - 2*asin(abs(w))", "acos(1-2*w^2) + 2*asin(abs(w)) + 1", "w"),
    ("arc tangent two ways", "atan2(w,1) - atan(w)", "atan2(w,1) - atan(w) + 1", "w"),
    ("tangent of arc tangent of two", "tan(atan2(w,v)) - w/v", "tan(atan2(w,v)) - w/v + 1", "wv"),
    ("sine of arc tangent of two", "sin(atan2(w,v)) - w/sqrt(w^2+v^2)", "sin(atan2(w,v)) - w/sqrt(w^2+v^2) - 1", "wv"),
    ("odd arc tangent", "atan(-w) + atan(w)", "atan(-w) + atan(w) + 1", "w"),
    ("exp of a sum", "exp(w+v) - exp(w)*exp(v)", "exp(w+v) + exp(w)*exp(v)", "wv"),
    ("exp of 1 more", "exp(w+1) - E*exp(w)", "exp(w+1) + E*exp(w)", "w"),
    ("exp of log of a sum", "exp(log(1+w^2)) - 1 - w^2", "exp(log(1+w^2)) + 1 + w^2", "w"),
    ("powers of 12, 4 and 3", "12^w - 4^w*3^w", "12^w + 4^w*3^w", "w"),
    ("powers of a root and of 8", "sqrt(2)^(6*w) - 8^w", "sqrt(2)^(6*w) + 8^w", "w"),
    ("powers of a half", "(1/2)^(2*w)*4^w - 1", "(1/2)^(2*w)*4^w + 1", "w"),
    ("log of exp", "log(exp(w)) - w", "log(exp(w)) - w + 1", "w"),
    ("log of a product of coordinates", "log(w*v) - log(w) - log(v)", "log(w*v) - log(w) - log(v) + 1", "wv"),
    ("log of a square", "log(w^2) - 2*log(abs(w))", "log(w^2) - 2*log(abs(w)) + 1", "w"),
    ("odd area sine", "log(w+sqrt(w^2+1)) + log(sqrt(w^2+1)-w)", "log(w+sqrt(w^2+1)) + log(sqrt(w^2+1)-w) + 1", "w"),
    ("arc tangent of the inverse", "atan(a) + atan(1/a) - pi/2", "atan(a) + atan(1/a) + pi/2", "a"),
    ("log of a product of parameters", "log(a*b) - log(a) - log(b)", "log(a*b) - log(a) - log(b) + 1", "ab"),
    ("log of a quotient", "log(a/b) - log(a) + log(b)", "log(a/b) - log(a) + log(b) + 1", "ab"),
    ("log of a power", "log(a^b) - b*log(a)", "log(a^b) - b*log(a) + 1", "ab"),
    ("power of a power", "(a^b)^2 - a^(2*b)", "(a^b)^2 + a^(2*b)", "ab"),
    ("power by exp", "exp(b*log(a)) - a^b", "exp(b*log(a)) + a^b", "ab"),
    ("root of a product", "sqrt(a*b) - sqrt(a)*sqrt(b)", "sqrt(a*b) + sqrt(a)*sqrt(b)", "ab"),
    ("nested root of parameters", "sqrt(a+b+2*sqrt(a*b)) - sqrt(a) - sqrt(b)", "sqrt(a+b+2*sqrt(a*b)) + sqrt(a)", "ab"),
]  # fmt: skip

#: Not zero, and taken for it by a float, a fixed prime or a fixed precision; none has a real zero but for a point.
NOT_ZERO = [
    ("exp of -200 w", "exp(-200*w)", "w"),
    ("exp of -1000", "exp(-1000)", ""),
    ("1e-30", "1e-30", ""),
    ("a power less 1", "w^40 - 1", "w"),
    ("1e9 and 1", "1e9*1e9 + 1 - 1e18", ""),
    ("22/7", "22/7 - pi", ""),
    ("355/113", "355/113 - pi", ""),
    ("Ramanujan", "exp(pi*sqrt(163)) - 262537412640768744", ""),
    ("nearly e^pi", "exp(pi) - pi - 20", ""),
    ("difference of tiny roots", "sqrt(1e20 + 1) - 1e10", ""),
]

TRAPS = [
    *(Trap(name, zero, sign) for name, zero, sign in NUMBERS),
    *(Trap(name, zero, sign, names) for name, zero, sign, names in FUNCTIONS),
]
