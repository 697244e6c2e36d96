"""Expressions that are zero and do not look it, or nearly are: what they decide, in each place where they may stand."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from dofkit.benchmark.trials.construction import KnownScene, known_scene, scene_of
from dofkit.benchmark.trials.contexts import CONTEXTS
from dofkit.benchmark.trials.rewritten import other_coordinates
from dofkit.benchmark.trials.steps import tiny_steps
from dofkit.benchmark.trials.traps import NOT_ZERO, TRAPS, Trap

#: Of the contexts and the ways of writing, how far on the next trap or base begins.
STRIDE = 5
#: The steps that are taken.
TAKEN = ("1e-12", "1e-30")
#: Words by which a group of tiny steps between finite relations is told apart.
FINITE = ("planes", "circle", "lines", "height", "angle")


def identities(quick: bool) -> Iterator[KnownScene]:
    """Zero by an identity, or missed by a constant that floating point does not see, or by a sign."""
    seen = set()
    for trap, text, zero, trait, number in _traps(9 if quick else 1):
        known = _in_context(trap, text, zero, number)
        if known is not None and known.name not in seen:
            seen.add(known.name)
            because = "zero by an identity" if zero else "an identity missed by a constant, or by a sign"
            yield replace(known, because=because, traits=(trait,))


def _traps(stride: int) -> Iterator[tuple[Trap, str, bool, str, int]]:
    """Each trap, an expression, whether it is zero, the trait, and in which context it stands."""
    for number, trap in enumerate(TRAPS[::stride]):
        yield trap, trap.zero, True, "hidden-identity", number
        if number % 3:
            yield trap, trap.tiny[number % 2], False, "near-identity", number
        if number % 3 == 1 and trap.sign:
            yield trap, trap.sign, False, "plain", number + STRIDE
    for number, (name, text, names) in enumerate(NOT_ZERO[::stride]):
        for turn in range(3):
            yield Trap(name, text, None, names, "^" not in text), text, False, "near-identity", number + STRIDE * turn


def _in_context(trap: Trap, text: str, zero: bool, number: int) -> KnownScene | None:
    """The trap in the first context from this on in which it can stand."""
    for turn in range(len(CONTEXTS)):
        found = CONTEXTS[(number + turn) % len(CONTEXTS)](trap, text, zero)
        if found is not None:
            return found
    return None


def steps(quick: bool) -> Iterator[KnownScene]:
    """Forms and relations a tiny exact step away from integrable, dependent or consistent ones."""
    for number, known in enumerate(tiny_steps()):
        if number % 23 if quick else not known.name.endswith(TAKEN):
            continue
        contradictory = known.truth.get("consistent") is False
        trait = "tiny-gap" if contradictory or any(word in known.group for word in FINITE) else "near-integrable"
        yield replace(known, because="a step is exact, however small", traits=(trait,))


def rewritten(quick: bool) -> Iterator[KnownScene]:
    """The same scene in other coordinates: what is true of it does not change."""
    for number, known in enumerate(other_coordinates()):
        if number % (40 if quick else STRIDE + 2):
            continue
        how = known.name.removeprefix(f"{known.group}, ")
        trait = "scale" if "scaled" in how else "offset" if "moved" in how else "rewritten"
        labels = [value for key, value in known.truth.items() if key.endswith(".holonomic")]
        other = "non-holonomic" if False in labels else "integrable"
        yield replace(known, because="coordinates do not change what is true", traits=(trait, other))


def bases(quick: bool) -> Iterator[KnownScene]:
    """Powers to different bases in the coefficients of forms."""
    for number, (name, zero) in enumerate(BASES[:: 4 if quick else 1]):
        trap = Trap(name, zero, None, "w")
        for turn, (text, is_zero) in enumerate(((zero, True), (f"{zero} + 1e-12", False), (f"{zero} + 1", False))):
            known = _in_context(trap, text, is_zero, 2 * number + turn)
            if known is not None:
                because = "one function, written to two bases" if is_zero else "off by a constant"
                yield replace(known, because=because, traits=("mixed-bases" if is_zero else "near-identity",))
    for power in (2,) if quick else (2, 3, 5, 8, 12):
        names = ["x", "y", "z"]
        same = scene_of(names, f"({2**power})^x dz + 2^({power} x) dy = 0")
        other = scene_of(names, f"({2**power})^x dz + 2^({power} x) y dx = 0")
        for name, made, dof, because in (
            (f"a factor 2^({power} x)", same, 2, "dz + dy"),
            (f"a contact form by 2^({power} x)", other, 3, "dz + y dx"),
        ):
            over = f"over the factor: {because}"
            yield known_scene(name, made, over, ("mixed-bases",), dof=dof, integrability={"c1": dof == 2})


#: Zero for every real w.
BASES = [
    ("4 and 2", "4^w - 2^(2*w)"),
    ("8 and 2", "8^w - 2^w*4^w"),
    ("2 and e", "2^w - exp(w*log(2))"),
    ("6, 2 and 3", "6^w - 2^w*3^w"),
    ("12, 2 and 3", "12^w - 2^(2*w)*3^w"),
    ("half and 2", "(1/2)^w*2^w - 1"),
    ("root 2 and 2", "sqrt(2)^(2*w) - 2^w"),
    ("10, 2 and 5", "10^w*5^(-w) - 2^w"),
    ("2 with 1 more", "2^(w+1) - 2*2^w"),
    ("e and 1 more", "exp(w+1) - E*exp(w)"),
    ("quotient of 3 and 2", "(3/2)^w - 3^w/2^w"),
    ("cosh and e", "2*cosh(w) - exp(w) - exp(-w)"),
    ("tanh and e", "tanh(w) - 1 + 2/(exp(2*w) + 1)"),
    ("9 and 3, halves", "9^(w/2) - 3^w"),
]

FAMILIES = {"identities": identities, "tiny steps": steps, "other coordinates": rewritten, "mixed bases": bases}
