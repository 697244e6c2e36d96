"""YAML and JSON documents: plain exact values, and the line and column of everything in them."""

from dofkit.base.documents.composer import Path
from dofkit.base.documents.document import Document, read_document

__all__ = ["Document", "Path", "read_document"]
