"""What makes a trial hard, and why a method fails on it, in one sentence a student understands."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from dofkit.methods.table import METHODS, MethodName

#: Every trait of a trial, in words.
TRAITS: Mapping[str, str] = {
    "plain": "independent holonomic equations in general position",
    "redundant": "dependent equations, whatever the lengths",
    "banana": "rigid parts that hinge about an implied line",
    "special-position": "parallel, concurrent or symmetric geometry",
    "shaky": "an infinitesimal motion that extends to no finite motion",
    "crossing": "branches that cross at the reference configuration",
    "near-singular": "a configuration very close to a singular one",
    "rounded": "a special position rounded to decimals",
    "measured": "measured geometry with a tolerance",
    "scale": "sizes or coefficients far apart",
    "offset": "geometry far from the origin",
    "non-holonomic": "forms that do not integrate",
    "integrable": "forms that integrate, closed or not",
    "together": "forms that integrate only together",
    "near-integrable": "forms that would be integrable without a tiny term",
    "nonlinear": "equations nonlinear in the velocities",
    "hidden-identity": "expressions that vanish by an identity that is hard to see",
    "near-identity": "expressions that are tiny but not zero",
    "mixed-bases": "exponentials and roots of several bases",
    "hidden-relation": "functions that depend on each other where the constraints hold",
    "time-hidden": "a holonomic equation implied by time-dependent differential constraints",
    "rheonomic": "constraints that depend on time",
    "squared": "equations that are powers",
    "sum-of-squares": "one equation that imposes several conditions",
    "high-power": "powers up to 64",
    "contradiction": "constraints that no configuration satisfies",
    "tiny-gap": "a contradiction, or contact, by a tiny gap",
    "real": "complex solutions without real ones",
    "many-blocks": "many small independent parts",
    "long-chain": "one long connected part",
    "large": "many unknowns in one dense part",
    "overconstrained": "joints in special position that overconstrain the motion",
    "joints": "bodies that rotate in space",
    "rolling": "rolling contacts",
    "inequality": "inequalities",
    "rewritten": "an equivalent equation",
    "combined": "equivalent only together with the other constraints",
    "irregular": "the same set, with a vanishing gradient",
    "one-branch": "one branch of the set",
    "tiny-difference": "a tiny difference",
    "differentiated": "the differential, or the integral",
    "weaker": "more or less than was asked",
    "wrong-sign": "a plain mistake",
}

_FORCED = "It does not see the holonomic equation that the differential constraints imply."
_FIRST_ORDER = (
    "It counts velocities at one point: an infinitesimal motion counts even if it extends to no finite motion."
)
_ONE_STEP = "It applies one step of Frobenius' test: a form can pass it and still not be integrable."

#: Sentences by method, each with the traits that it explains.
_SENTENCES: Mapping[MethodName, Sequence[tuple[str, str]]] = {
    "auto": (
        (
            "It does not guess: where neither an engine nor a proof decides, it answers undecided.",
            "near-singular rounded measured hidden-identity near-identity hidden-relation nonlinear tiny-gap real "
            "crossing special-position shaky sum-of-squares high-power squared irregular one-branch tiny-difference "
            "combined rewritten offset scale",
        ),
        ("Its exact arithmetic on many coupled unknowns takes longer than the limit.", "large joints"),
    ),
    "count": (
        (
            "It subtracts one freedom for every equation, although one is implied by the others.",
            "redundant overconstrained special-position crossing shaky",
        ),
        (
            "The total is right although one part has a link too many and another a link too few.",
            "banana",
        ),
        ("It counts measured geometry as exact, independent equations.", "measured rounded"),
        ("It counts equations regardless of the geometry, at which they are nearly dependent.",
         "near-singular"),
        (
            "It calls a form non-holonomic because its mixed partial derivatives differ, although a factor makes them "
            "agree; and it does not count the relation that a form integrates to.",
            "integrable together near-integrable combined",
        ),
        ("It calls every equation nonlinear in the velocities non-holonomic, without factoring it.", "nonlinear"),
        (
            _FORCED,
            "time-hidden",
        ),
        ("It counts an equation that is satisfied identically, because it does not know the identity.",
         "hidden-identity hidden-relation mixed-bases near-identity"),
        ("It counts one equation as one condition, although over the reals it imposes another number.",
         "sum-of-squares squared real high-power"),
        ("It gives a number even if the equations contradict each other.", "contradiction tiny-gap"),
        ("It compares texts, so an equivalent equation looks different.", "rewritten rheonomic scale offset"),
        ("It tests each form by its own partial derivatives, and not the forms together.",
         "non-holonomic rolling joints"),
    ),
    "graph": (
        (
            "It takes the geometry for generic and does not see that it is parallel, concurrent or symmetric.",
            "special-position overconstrained shaky crossing near-singular rounded measured joints",
        ),
        ("It ignores rolling contacts and written equations: it knows links and joints only.",
         "rolling non-holonomic integrable nonlinear"),
        ("It takes lengths for generic, so it does not see that they contradict each other.",
         "contradiction tiny-gap real"),
        ("No counting rule is right for all links in space, so a rank at random positions decides.",
         "banana large"),
    ),
    "field": (
        (
            "It computes with numbers modulo a prime, which are neither positive nor negative: whether a real solution "
            "exists, or is the only one, it cannot tell.",
            "real sum-of-squares contradiction tiny-gap one-branch crossing shaky squared inequality",
        ),
        (
            "An expression that vanishes by an identity unknown to its generators looks non-zero, so it does not "
            "decide where there may be one.",
            "hidden-identity hidden-relation near-identity mixed-bases",
        ),
        ("A small prime divides some of the non-zero numbers.",
         "plain redundant banana non-holonomic integrable together near-integrable special-position high-power large "
         "long-chain many-blocks joints overconstrained rolling rheonomic"),
        ("Measured numbers are not exact, and modulo a prime no number is close to zero.",
         "measured rounded near-singular"),
        ("It samples complex solutions, some of which are not real, so they refute nothing.",
         "rewritten combined irregular tiny-difference differentiated weaker wrong-sign nonlinear"),
    ),
    "balls": (
        ("It cannot distinguish a number smaller than its precision from 0.",
         "near-identity near-integrable near-singular rounded tiny-gap tiny-difference scale offset high-power"),
        ("It cannot prove that a number is 0: the interval around it only gets smaller.",
         "hidden-identity hidden-relation mixed-bases redundant special-position overconstrained integrable together"),
        ("It searches for a real point, and failing to find one proves nothing.", "contradiction real time-hidden"),
        ("At a singular point the certificate of a real solution fails.",
         "crossing shaky squared sum-of-squares irregular one-branch banana"),
        ("It computes every entry of a matrix with hundreds of bits.", "large long-chain many-blocks joints"),
    ),
    "exact": (
        (
            _FIRST_ORDER,
            "shaky crossing special-position squared sum-of-squares irregular",
        ),
        ("It knows rational numbers only, and these positions are irrational.", "measured mixed-bases"),
        (_ONE_STEP,
         "non-holonomic rolling integrable near-integrable"),
        (
            _FORCED,
            "time-hidden together",
        ),
        ("It ignores inequalities and equations that are nonlinear in the velocities.", "nonlinear inequality"),
        ("It found no rational configuration, or one that does not show the contradiction.",
         "contradiction tiny-gap real"),
        ("Without a reference configuration it needs a rational point, which it finds for linear equations only.",
         "plain redundant banana joints rheonomic high-power rewritten combined one-branch tiny-difference "
         "differentiated weaker wrong-sign large long-chain many-blocks scale offset"),
        ("It takes dependent functions for independent.",
         "hidden-identity hidden-relation near-identity"),
    ),
    "numeric": (
        ("It takes numbers below its tolerance for 0, and rounding errors above it for non-zero.",
         "near-singular near-integrable near-identity tiny-gap tiny-difference scale offset rounded measured"),
        (
            _FIRST_ORDER,
            "shaky crossing special-position overconstrained squared sum-of-squares",
        ),
        (_ONE_STEP,
         "non-holonomic rolling integrable"),
        (
            _FORCED,
            "time-hidden together",
        ),
        ("It ignores inequalities and equations that are nonlinear in the velocities.", "nonlinear inequality"),
        ("Its search found no configuration, or stopped where the equations are only nearly satisfied.",
         "contradiction real high-power large hidden-relation mixed-bases rheonomic joints"),
        ("It looks at a few points only, which may all lie on one branch.", "one-branch irregular combined"),
        ("It takes a singular value decomposition for each constraint that it leaves out.",
         "long-chain many-blocks redundant banana"),
        ("It evaluates in 16 digits, which cancel here.", "hidden-identity"),
    ),
    "symbolic": (
        (
            "It looks at all of space, so it takes equations for independent that depend on each other only where "
            "the constraints are satisfied.",
            "hidden-relation special-position shaky crossing squared sum-of-squares real combined together "
            "contradiction",
        ),
        ("It takes an expression for non-zero if it cannot simplify it to 0.",
         "hidden-identity near-identity mixed-bases redundant banana overconstrained measured rounded"),
        (_ONE_STEP,
         "non-holonomic rolling integrable near-integrable"),
        (
            _FORCED,
            "time-hidden rheonomic",
        ),
        ("It ignores inequalities and equations that are nonlinear in the velocities.", "nonlinear inequality"),
        ("Its expressions grow with every step of an elimination, until simplify takes longer than the limit.",
         "large long-chain many-blocks joints high-power"),
        ("It compares differences only: a multiple, a power or a branch of the same equation looks like another one.",
         "rewritten irregular one-branch scale offset"),
        ("A rank does not show whether the equations can be satisfied.", "tiny-gap near-singular"),
    ),
}  # fmt: skip

#: Why a method takes long, where that is not its cost alone.
_SLOW: Mapping[str, str] = {
    "auto": "Exact arithmetic on the coupled equations takes longer than the limit.",
    "field": "Exact elimination of the coupled equations takes longer than the limit.",
    "balls": "It computes every entry of a matrix with hundreds of bits, and with more where they do not suffice.",
    "exact": "Its rational numbers grow with every step of an elimination.",
    "numeric": "It takes a singular value decomposition for each constraint that it leaves out, or its search is long.",
    "symbolic": "Its expressions grow with every step of an elimination, until simplify takes longer than the limit.",
    "graph": "Ranks in space at random positions, one for each redundant link, take longer than the limit.",
    "count": "Even reading that many equations takes longer than the limit.",
}

WHY: Mapping[tuple[str, str], str] = {
    (method, trait): sentence
    for method, sentences in _SENTENCES.items()
    for sentence, traits in sentences
    for trait in traits.split()
}


def explained(method: str, question: str, traits: Sequence[str], outcome: str, reason: str = "") -> str:
    """Why a method fails on a trial, as a sentence; never empty.

    ``traits``: of the trial, the one that matters most first; ``outcome``: ``wrong``, ``undecided``, ``cannot`` or
    ``timed out``; ``reason``: what the method said itself.
    """
    row = next((row for name, row in METHODS.items() if name == method), None)
    cannot = _sentence(row.cannot) if row is not None else f"{method} does not answer this."
    if outcome == "cannot" or (outcome == "undecided" and reason):
        return _sentence(reason) if reason else cannot
    if outcome == "timed out":
        costs = [use.costs for asked, use in row.uses.items() if asked == question] if row is not None else []
        return " ".join([_SLOW.get(method, cannot), *(f"Its cost: {cost}." for cost in costs)])
    return next((WHY[method, trait] for trait in traits if (method, trait) in WHY), cannot)


def _sentence(text: str) -> str:
    return f"{text[:1].upper()}{text[1:]}{'' if text.endswith('.') else '.'}"
