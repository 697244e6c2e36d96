"""The checker: a second, small program that rechecks every claim of a certificate from the scene's text alone.

It shares nothing with the engines that made the claims, and imports nothing of dofkit outside this room.
"""

from dofkit.checker.trees import CheckError
from dofkit.checker.verification import Verification, verify

__all__ = ["CheckError", "Verification", "verify"]
