"""The README as the first page of the site."""

from __future__ import annotations

from dofkit.site.markdown import SitePage
from dofkit.site.report_pages import THEOREMS


def readme_page(readme: str) -> SitePage:
    """Return the first page: the README, with its links as the site has them.

    >>> readme_page("[how](dofkit/site/pages/tutorial.md) and [why](dofkit/THEOREMS.md)").text
    '[how](tutorial.md) and [why](about/theorems.md)'
    """
    return SitePage(
        "index.md", readme.replace("](dofkit/site/pages/", "](").replace("](dofkit/THEOREMS.md)", f"]({THEOREMS})")
    )
