"""YAML and JSON documents: plain exact values, and the line and column of everything in them."""

from dofkit.documents.document import Document, read_document
from dofkit.documents.flow import Path

__all__ = ["Document", "Path", "read_document"]
