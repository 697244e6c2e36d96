"""Numbers that are nearly 0, and points that make a zero probable."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import pytest

import dofkit
from dofkit.base.documents import read_document
from dofkit.exact.ring.radicals import prime_powers
from dofkit.exact.ring.ring import Ring
from dofkit.exact.zero import independent_generators, is_proved_zero, is_zero, zero_and_verdict
from dofkit.expressions import tree as ex
from dofkit.expressions.text import Names, parse_expression

#: Expressions, and whether they are made of what is independent.
GENERATORS = read_document((Path(__file__).parent / "generators.yaml").read_bytes(), "generators.yaml").value
#: Sums of arcs that are 0.
ARCS = ["asin(3/5 + {e}) + asin(4/5) - pi/2", "2*asin(3/5 + {e}) - asin(24/25)", "atan(1/2 + {e}) + atan(1/3) - pi/4"]


@pytest.mark.parametrize("arcs", ARCS)
def test_arcs_that_nearly_close_do_not(arcs: str) -> None:
    """10^-120 is less than the bits that are looked at first tell from 0."""
    for e, consistent in (("0", True), ("1/(10^60*10^60)", False), ("-1/(10^60*10^60)", False)):
        report = dofkit.classify({"coordinates": ["x"], "constraints": ["x = 0", f"x + {arcs.format(e=e)} = 0"]})
        assert report.consistent in (consistent, None), e


@pytest.mark.parametrize("arcs", ARCS)
def test_a_form_with_a_coefficient_that_is_nearly_zero_does_not_integrate(arcs: str) -> None:
    """dz + c y dx is a contact form wherever c is not 0, however small; and z = C where it is."""
    for e, holonomic in (("0", True), ("1/(10^60*10^60)", False)):
        form = f"dz + ({arcs.format(e=e)}) y dx = 0"
        report = dofkit.classify({"coordinates": ["x", "y", "z"], "constraints": [form]})
        if report.constraints[0].holonomic is None and holonomic:
            continue  # undecided: no ball tells 0 from a number as small
        assert report.constraints[0].holonomic is holonomic
        assert report.dof == (2 if holonomic else 3)
        scene = {"coordinates": ["x", "y", "z"], "constraints": [form]}
        assert dofkit.ask(scene, "dof").value == report.dof
        assert dofkit.ask(scene, "integrability").value == {"c1": holonomic}
        same = dofkit.ask({**scene, "constraints": ["dz = 0"]}, "equivalence", {"constraint": "c1", "text": form})
        assert same.value in (holonomic, None)
        assert dofkit.derived_flag(scene) in ([1] if holonomic else [1, 0], None)


@pytest.mark.parametrize(("texts", "independent"), GENERATORS)
def test_which_generators_are_independent(texts: list[str], independent: bool) -> None:
    names = Names(coordinates=frozenset("xyz"), functions={"h": 1})
    relations = [parse_expression(text, names) for text in texts]
    ring = Ring(relations)
    assert all(ring.node(e) is not None for e in relations)
    assert independent_generators(ring) is independent


X = ex.coordinate("x")


@pytest.mark.parametrize(
    ("e", "independent"),
    [
        (ex.fn("exp", ex.num(1000)), True),  # one transcendental constant [Lindemann1882]
        (ex.E, True),
        (ex.fn("tanh", ex.num(1000)), True),
        (ex.fn("exp", ex.num(Fraction(1, 3))) + ex.E, True),  # powers of e^(1/3)
        (ex.fn("exp", ex.num(1000)) + ex.E, False),  # one is the other's 1000th power, which the ring does not know
        (ex.fn("exp", X) + ex.fn("exp", X * 1000), False),
        (ex.fn("exp", X * 1000), True),
        (ex.fn("cos", ex.num(1)), True),
        (ex.fn("cos", ex.num(1)) + ex.E, False),  # true by Lindemann and Weierstrass, but not looked at
        (ex.PI, True),
        (ex.PI + ex.E, False),  # nobody knows
        (ex.fn("cos", ex.PI * Fraction(1, 7)), False),  # algebraic
        (ex.fn("exp", X + 1), True),
        (ex.fn("exp", ex.PI), False),
        (ex.fn("exp", ex.sqrt(ex.num(2))), False),
    ],
)
def test_one_transcendental_constant_is_independent(e: ex.Expr, independent: bool) -> None:
    ring = Ring([e])
    ring.node(e)
    assert independent_generators(ring) is independent


def test_a_number_that_no_ball_tells_from_0_is_no_identity() -> None:
    """1 - tanh(1000) is 2/(e^2000 + 1): x + abs(x) is it nowhere, its negative at one place each side."""
    tiny = ex.ONE - ex.fn("tanh", ex.num(1000))
    assert zero_and_verdict(tiny, frozenset()) == (False, "proved")
    hidden = tiny + ex.fn("asin", ex.num(Fraction(1, 3))) - ex.fn("asin", ex.num(Fraction(1, 3)))
    assert not is_proved_zero(hidden, frozenset())
    for text in ("x + abs(x) + 1 - tanh(1000) = 0", "x + abs(x) = 1 - tanh(1000)"):
        report = dofkit.classify({"coordinates": ["x", "y"], "constraints": [text]})
        assert report.dof is None or report.dof == 1


def test_what_has_a_value_nowhere_that_was_tried_is_not_taken_for_zero() -> None:
    """log(-1 - x^2) has none at all, and sqrt(1 - 10^6 (x - 1/3)^2) has one in a narrow band only."""
    x = ex.coordinate("x")
    narrow = ex.sqrt(1 - 10**6 * (x - ex.num(Fraction(1, 3))) ** 2)
    for e in (ex.fn("log", -1 - x * x), ex.fn("log", narrow) + 1):
        assert zero_and_verdict(e, frozenset()) == (None, "undecided")


@pytest.mark.parametrize("text", read_document((Path(__file__).parent / "identities.yaml").read_bytes(), "yaml").value)
def test_what_is_zero_is_seen_to_be_and_what_is_not_is_not(text: str) -> None:
    e = parse_expression(text, Names(coordinates=frozenset("xy")))
    assert is_zero(e, frozenset({X}))
    assert zero_and_verdict(e + ex.num(Fraction(1, 10**9)), frozenset({X})) == (False, "proved")


def test_the_prime_powers_of_a_large_number() -> None:
    assert prime_powers(2**200 * 3 * 41**30) == [(2, 200), (3, 1), (41**30, 1)]
