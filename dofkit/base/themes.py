"""Light and dark: in which of them a piece of a page is drawn. Its colours are `light-dark(...)` of style sheets."""

from __future__ import annotations

#: What a page is in, as it says itself: JupyterLab, VS Code, Sphinx and others; else what the reader's system wishes.
_SAID = {
    "dark": ("[data-jp-theme-light=false]", ".vscode-dark", "[data-theme=dark]", ".theme-dark"),
    "light": ("[data-jp-theme-light=true]", ".vscode-light", "[data-theme=light]", ".theme-light"),
}


def schemes(piece: str) -> str:
    """The style that puts a ``piece`` in the scheme of the page around it.

    >>> schemes(".a")[:30]
    '.a{color-scheme:light dark}[da'
    """
    said = (f"{','.join(f'{page} {piece}' for page in pages)}{{color-scheme:{one}}}" for one, pages in _SAID.items())
    return "".join([f"{piece}{{color-scheme:light dark}}", *said])
