"""YAML and JSON documents: plain exact values, and the line and column of everything in them."""

from dofkit.base.documents.document import Document, read_document
from dofkit.base.documents.fast_flow import Path

__all__ = ["Document", "Path", "read_document"]
