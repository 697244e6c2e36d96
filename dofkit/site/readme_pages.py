"""Pages that are parts of the README: the start, the architecture, what is not decided."""

from __future__ import annotations

import re
from collections.abc import Iterator

from dofkit.site.markdown import SitePage, page
from dofkit.site.report_pages import THEOREMS

#: Sections of the README that have a page of their own.
APART = {"Architecture": "about/architecture.md", "Known limits": "about/limits.md"}


def readme_pages(readme: str) -> Iterator[SitePage]:
    """The README as the first page, but for the sections that are pages themselves."""
    start, *rest = re.split(r"^## (.*)\n", readme, flags=re.MULTILINE)
    parts = [start.rstrip()]
    for title, text in zip(rest[::2], rest[1::2], strict=True):
        if title in APART:
            raised = re.sub(r"^###", "##", text.strip(), flags=re.MULTILINE)
            yield SitePage(APART[title], page(title, raised))
        else:
            parts.append(f"## {title}\n{text.rstrip()}")
    yield SitePage("index.md", within("\n\n".join(parts)) + "\n")


def within(text: str) -> str:
    """The README's text with its links as the site has them.

    >>> within("[how](dofkit/site/pages/tutorial.md) and [why](dofkit/THEOREMS.md)")
    '[how](tutorial.md) and [why](about/theorems.md)'
    """
    return text.replace("](dofkit/site/pages/", "](").replace("](dofkit/THEOREMS.md)", f"]({THEOREMS})")
