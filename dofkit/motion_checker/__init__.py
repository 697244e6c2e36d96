"""Equations of motion rechecked: what `dofkit.checker` is asked to look at besides the claims about constraints.

It reads energies and forces from the scene's text for itself, and imports nothing of dofkit but the checker.
"""

from dofkit.motion_checker.equations import MOTION_RULES, TOLD

__all__ = ["MOTION_RULES", "TOLD"]
