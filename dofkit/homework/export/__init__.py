"""What a course platform is given to grade an assignment by itself."""

from dofkit.homework.export.gradescope import PYTHONS, ExportError, export_gradescope
from dofkit.homework.export.otter import OtterError, export_otter

__all__ = ["PYTHONS", "ExportError", "OtterError", "export_gradescope", "export_otter"]
