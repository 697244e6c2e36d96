"""What a course platform is given to grade an assignment by itself."""

from dofkit.homework.export.gradescope import PYTHONS, ExportError, export_gradescope

__all__ = ["PYTHONS", "ExportError", "export_gradescope"]
