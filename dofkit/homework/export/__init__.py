"""What a course platform is given to grade an assignment by itself."""

from dofkit.homework.export.gradescope import PYTHON, ExportError, export_gradescope
from dofkit.homework.export.otter import OtterError, export_otter

__all__ = ["PYTHON", "ExportError", "OtterError", "export_gradescope", "export_otter"]
