"""Trees and numbers as texts in the grammar of scenes."""

from __future__ import annotations

from fractions import Fraction

from dofkit.checker.trees import Tree


def number_text(value: Fraction | int) -> str:
    """A rational number."""
    value = Fraction(value)
    return str(value.numerator) if value.denominator == 1 else f"{value.numerator}/{value.denominator}"


def text_of(tree: Tree) -> str:
    """A tree as a text that is read as the same tree, up to the order of what commutes."""
    head = tree.head
    if isinstance(tree.value, Fraction):
        return number_text(tree.value) if tree.value >= 0 else f"({number_text(tree.value)})"
    if head == "symbol":
        return str(tree.value)
    if head == "pi":
        return "pi"
    if head == "sum":
        return "(" + " + ".join(text_of(part) for part in tree.below) + ")"
    if head == "product":
        return "*".join(_factor(part) for part in tree.below)
    if head == "power":
        return f"({text_of(tree.below[0])})^({text_of(tree.below[1])})"
    if head == "apply":
        return _applied(tree)
    return f"{head}({', '.join(text_of(part) for part in tree.below)})"


def _factor(tree: Tree) -> str:
    text = text_of(tree)
    return f"({text})" if "/" in text or tree.head == "product" else text


def _applied(tree: Tree) -> str:
    """A declared function, or its derivative by its arguments."""
    called = f"{tree.value}({', '.join(text_of(part) for part in tree.below)})"
    for argument, order in zip(tree.below, tree.orders, strict=True):
        for _ in range(order):
            called = f"diff({called}, {text_of(argument)})"
    return called
