"""What makes a trial hard, and why a method fails on it, in one sentence a student understands."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from dofkit.methods.names import MethodName
from dofkit.methods.table import METHODS

#: Every trait of a trial, in words.
TRAITS: Mapping[str, str] = {
    "plain": "independent finite equations and nothing special",
    "redundant": "more equations than independent ones, at any lengths",
    "banana": "rigid parts hinged along a line that nobody wrote",
    "special-position": "parallel, concurrent or symmetric geometry",
    "shaky": "a motion to first order that no finite motion follows",
    "crossing": "branches that cross at the drawing",
    "near-singular": "a tiny step beside a singular pose",
    "rounded": "a special position rounded to decimals",
    "measured": "measured geometry with a tolerance",
    "scale": "sizes or coefficients far apart",
    "offset": "drawn far from the origin",
    "non-holonomic": "forms that do not integrate",
    "integrable": "forms that integrate, closed or not",
    "together": "forms that integrate only together",
    "near-integrable": "forms that integrate but for a tiny term",
    "nonlinear": "equations nonlinear in the velocities",
    "hidden-identity": "zero by an identity that is not to be seen",
    "near-identity": "as good as zero, and not zero",
    "mixed-bases": "exponentials and roots of several bases",
    "hidden-relation": "functions that depend on each other where the constraints hold",
    "time-hidden": "a finite relation that differential constraints with time force",
    "rheonomic": "constraints that time enters",
    "squared": "equations that are powers",
    "sum-of-squares": "one equation that says several",
    "high-power": "powers up to 64",
    "contradiction": "constraints that nothing satisfies",
    "tiny-gap": "a contradiction, or contact, by a tiny gap",
    "real": "complex solutions without real ones",
    "many-blocks": "many small independent parts",
    "long-chain": "one long connected part",
    "large": "many unknowns in one dense part",
    "overconstrained": "joints in special position, more than the motion needs",
    "joints": "bodies in space that turn",
    "rolling": "rolling contacts",
    "inequality": "inequalities",
    "rewritten": "the same said otherwise",
    "combined": "the same beside the other constraints only",
    "irregular": "the same set without a gradient",
    "one-branch": "a part of the set",
    "tiny-difference": "a tiny difference",
    "differentiated": "the differential, or the integral",
    "weaker": "more or less than was asked",
    "wrong-sign": "a plain mistake",
}

_FORCED = "It does not see the finite relation that differential constraints force without anybody having written it."
_FIRST_ORDER = "It counts velocities at one point: a motion to first order that nothing follows counts like any other."
_ONE_STEP = "It takes one step of Frobenius' test: a form may pass it and yet not integrate in the end."

#: Sentences by method, each with the traits that it explains.
_SENTENCES: Mapping[MethodName, Sequence[tuple[str, str]]] = {
    "auto": (
        (
            "It does not guess: where neither engine nor a proof decides, it says undecided.",
            "near-singular rounded measured hidden-identity near-identity hidden-relation nonlinear tiny-gap real "
            "crossing special-position shaky sum-of-squares high-power squared irregular one-branch tiny-difference "
            "combined rewritten offset scale",
        ),
        ("Its exact arithmetic on many unknowns that hang together takes longer than it was given.", "large joints"),
    ),
    "count": (
        (
            "It takes every equation for one freedom, although one follows from the others.",
            "redundant overconstrained special-position crossing shaky",
        ),
        (
            "The count of the whole comes out although one part holds a link too many and another one too few.",
            "banana",
        ),
        ("It counts what was measured as exact equations, independent of each other.", "measured rounded"),
        ("It counts equations and does not look at the drawing, where they nearly depend on each other.",
         "near-singular"),
        (
            "It calls a form non-holonomic because its mixed partial derivatives differ, although a factor makes them "
            "agree; and it does not count what a form integrates to.",
            "integrable together near-integrable combined",
        ),
        ("It calls what is nonlinear in the velocities non-holonomic, without factoring it.", "nonlinear"),
        (
            _FORCED,
            "time-hidden",
        ),
        ("It counts an equation that says nothing new, because it does not know the identity behind it.",
         "hidden-identity hidden-relation mixed-bases near-identity"),
        ("It counts one equation as one condition, although over the reals it says another number of them.",
         "sum-of-squares squared real high-power"),
        ("It gives a number whether the equations can be satisfied together or not.", "contradiction tiny-gap"),
        ("It compares texts: the same said otherwise looks like something else.", "rewritten rheonomic scale offset"),
        ("It tests each form by its own partial derivatives, and not what the forms say together.",
         "non-holonomic rolling joints"),
    ),
    "graph": (
        (
            "It takes the geometry for generic: what is parallel, concurrent or symmetric it does not see.",
            "special-position overconstrained shaky crossing near-singular rounded measured joints",
        ),
        ("It counts rolling contacts and written equations for nothing: it knows links and joints only.",
         "rolling non-holonomic integrable nonlinear"),
        ("It takes lengths for generic, so that it does not see that they cannot be met together.",
         "contradiction tiny-gap real"),
        ("Links in space have no counting rule that is always right, so that a rank at random places decides.",
         "banana large"),
    ),
    "field": (
        (
            "It computes with numbers modulo a prime, which are neither positive nor negative: whether a real solution "
            "exists, or is the only one, it cannot tell.",
            "real sum-of-squares contradiction tiny-gap one-branch crossing shaky squared inequality",
        ),
        (
            "An identity between functions that its generators do not know looks like non-zero to it, so that it does "
            "not decide where there may be one.",
            "hidden-identity hidden-relation near-identity mixed-bases",
        ),
        ("A small prime divides some of the numbers that are not 0.",
         "plain redundant banana non-holonomic integrable together near-integrable special-position high-power large "
         "long-chain many-blocks joints overconstrained rolling rheonomic"),
        ("Measured numbers are not exact, and modulo a prime nearly zero is as far from zero as anything.",
         "measured rounded near-singular"),
        ("It draws states of the complex solutions, of which some are no real ones, and so does not refute with them.",
         "rewritten combined irregular tiny-difference differentiated weaker wrong-sign nonlinear"),
    ),
    "balls": (
        ("A number smaller than its precision is not told from 0.",
         "near-identity near-integrable near-singular rounded tiny-gap tiny-difference scale offset high-power"),
        ("That something is 0 it cannot prove: its interval only gets smaller around it.",
         "hidden-identity hidden-relation mixed-bases redundant special-position overconstrained integrable together"),
        ("It looks for a real point, and finding none proves nothing.", "contradiction real time-hidden"),
        ("At a singular point the certificate of a real solution fails.",
         "crossing shaky squared sum-of-squares irregular one-branch banana"),
        ("It computes at hundreds of bits with every entry of a matrix.", "large long-chain many-blocks joints"),
    ),
    "exact": (
        (
            _FIRST_ORDER,
            "shaky crossing special-position squared sum-of-squares irregular",
        ),
        ("It knows rational numbers only, and these places are irrational.", "measured mixed-bases"),
        (_ONE_STEP,
         "non-holonomic rolling integrable near-integrable"),
        (
            _FORCED,
            "time-hidden together",
        ),
        ("It leaves out what is nonlinear in the velocities, and inequalities.", "nonlinear inequality"),
        ("It found no rational configuration, or looks at one that does not show the contradiction.",
         "contradiction tiny-gap real"),
        ("Without a drawing it has to solve for a rational point, which it does for linear equations only.",
         "plain redundant banana joints rheonomic high-power rewritten combined one-branch tiny-difference "
         "differentiated weaker wrong-sign large long-chain many-blocks scale offset"),
        ("It takes functions for independent of each other that are not.",
         "hidden-identity hidden-relation near-identity"),
    ),
    "numeric": (
        ("It takes what is smaller than its tolerance for 0, and what rounding leaves for more than 0.",
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
        ("It leaves out what is nonlinear in the velocities, and inequalities.", "nonlinear inequality"),
        ("Its search failed to find a configuration, or stopped where the equations only nearly hold.",
         "contradiction real high-power large hidden-relation mixed-bases rheonomic joints"),
        ("It looks at a few points only, which may all lie on one branch.", "one-branch irregular combined"),
        ("It takes a singular value decomposition for each constraint that it leaves out.",
         "long-chain many-blocks redundant banana"),
        ("It evaluates in 16 digits, which cancel here.", "hidden-identity"),
    ),
    "symbolic": (
        (
            "It looks at the whole space: equations that depend on each other only where the constraints hold, it "
            "takes for independent.",
            "hidden-relation special-position shaky crossing squared sum-of-squares real combined together "
            "contradiction",
        ),
        ("It takes for non-zero what it cannot simplify to 0.",
         "hidden-identity near-identity mixed-bases redundant banana overconstrained measured rounded"),
        (_ONE_STEP,
         "non-holonomic rolling integrable near-integrable"),
        (
            _FORCED,
            "time-hidden rheonomic",
        ),
        ("It leaves out what is nonlinear in the velocities, and inequalities.", "nonlinear inequality"),
        ("Its expressions grow with every step of an elimination, until simplify does not end.",
         "large long-chain many-blocks joints high-power"),
        ("It compares differences only: a multiple, a power or a branch of the same equation looks like another one.",
         "rewritten irregular one-branch scale offset"),
        ("A rank says nothing of whether the equations can be satisfied at all.", "tiny-gap near-singular"),
    ),
}  # fmt: skip

#: Why a method takes long, where that is not its cost alone.
_SLOW: Mapping[str, str] = {
    "auto": "Exact arithmetic on what hangs together here takes longer than it was given.",
    "field": "Exact elimination on what hangs together here takes longer than it was given.",
    "balls": "It computes at hundreds of bits with every entry of a matrix, and climbs to more where they do not tell.",
    "exact": "Its rational numbers grow with every step of an elimination.",
    "numeric": "It takes a singular value decomposition for each constraint that it leaves out, or searches long.",
    "symbolic": "Its expressions grow with every step of an elimination, until simplify does not end.",
    "graph": "Ranks in space at random places, once for each link too many, take longer than it was given.",
    "count": "Even reading that many equations takes longer than it was given.",
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
