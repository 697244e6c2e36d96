"""What a course platform is given to grade an assignment by itself."""

from dofkit.homework.export.gradescope import PYTHON, ExportError, export_gradescope

__all__ = ["PYTHON", "ExportError", "export_gradescope"]
