"""A folder of pages, served from this machine and compressed as a web server does."""

from __future__ import annotations

import gzip
import sys
import time
from functools import cache
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from threading import Lock
from typing import Any, ClassVar, NamedTuple

#: Media types that the server of Python does not know.
_KINDS = {".mjs": "text/javascript", ".wasm": "application/wasm"}
#: Files that are compressed already.
_PACKED = (".zst", ".bin")
_CHUNK = 1 << 16


@cache
def _compressed(path: Path) -> bytes:
    return gzip.compress(path.read_bytes())


class PageHandler(SimpleHTTPRequestHandler):
    """Files, compressed as a web server does; archives are compressed already."""

    protocol_version = "HTTP/1.1"
    extensions_map = SimpleHTTPRequestHandler.extensions_map | _KINDS
    sent: ClassVar[int] = 0
    #: Bytes in a second that all answers together may take; None for as many as there can be.
    rate: ClassVar[float | None] = None
    _turn: ClassVar[Lock] = Lock()

    def do_GET(self) -> None:
        path = Path(self.translate_path(self.path))
        path = path / "index.html" if path.is_dir() else path
        if not path.is_file():
            self.send_error(404)
            return
        data = path.read_bytes() if path.suffix in _PACKED else _compressed(path)
        self.send_response(200)
        self.send_header("Content-Type", self.guess_type(path))
        if path.suffix not in _PACKED:
            self.send_header("Content-Encoding", "gzip")
        self.send_header("Content-Length", str(len(data)))
        self.end_headers()
        for start in range(0, len(data), _CHUNK):
            if rate := PageHandler.rate:  # a test may end, and with it the slow line, while one waits for its turn
                with PageHandler._turn:
                    time.sleep(_CHUNK / rate)
            self.wfile.write(data[start : start + _CHUNK])
        PageHandler.sent += len(data)

    def log_message(self, *_: object) -> None:
        """Say nothing."""


class PageServer(ThreadingHTTPServer):
    """A server that a page may leave in the middle of an answer."""

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Print what went wrong, unless the page has left."""
        if not isinstance(sys.exception(), ConnectionError):
            super().handle_error(request, client_address)


class Served(NamedTuple):
    """The address of the pages, the folder that is served, and the server."""

    url: str
    folder: Path
    server: PageServer

    @property
    def sent(self) -> int:
        """Bytes that were sent so far."""
        return PageHandler.sent
