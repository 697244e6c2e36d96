"""The catalog as a gallery: every scene with its picture and its answer, a page a folder."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby
from operator import attrgetter

from dofkit.site.markdown import SitePage, code, fence, folded, page, picture, prose
from dofkit.site.shown_scenes import ShownScene

FOLDER = "gallery"


def gallery_pages(catalog: Sequence[ShownScene], sources: dict[str, str]) -> Iterator[SitePage]:
    """The pages and pictures; ``sources``: what each folder of the catalog was taken from."""
    told = []
    for folder, scenes in groupby(catalog, key=attrgetter("folder")):
        members = list(scenes)
        source = sources.get(folder, folder)
        cards = "\n".join(_card(scene) for scene in members)
        told += [
            f"## {prose(source)}",
            f"[{len(members)} scenes]({folder}.md)",
            f'<div class="gallery">\n{cards}\n</div>',
        ]
        yield SitePage(f"{FOLDER}/{folder}.md", page(source, *(_entry(scene) for scene in members)))
        yield from (SitePage(f"{FOLDER}/{scene.name}.svg", scene.svg) for scene in members)
    yield SitePage(
        f"{FOLDER}/index.md",
        page(
            "Gallery",
            f"The {len(catalog)} scenes of the catalog, with their answers: f is the number of degrees of freedom. The "
            "name of a scene can be used wherever a file is expected: `dofkit classify NAME`. Click on a picture to "
            "see the text of the scene and the full report.",
            *told,
        ),
    )


def _entry(scene: ShownScene) -> str:
    return "\n\n".join(
        (
            f"## {prose(scene.title)} {{#{scene.name}}}",
            f"{code(scene.name)}: {prose(scene.answer)}",
            picture(f"{scene.name}.svg", scene.alternative),
            folded("The scene", fence("yaml", scene.written)),
            folded("The report", fence("text", scene.report)),
        )
    )


def _card(scene: ShownScene) -> str:
    drawn = picture(f"{scene.name}.svg", scene.alternative)
    told = f"<strong>{_html(scene.title)}</strong><br>{_html(scene.answer)}"
    return f'<a class="card" href="{scene.folder}.html#{scene.name}">{drawn}<span>{told}</span></a>'


def _html(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
