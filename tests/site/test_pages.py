"""The generated pages: every type, field, verdict, command, theorem and scene is told of, from where it is defined."""

from __future__ import annotations

import re
import tomllib

import pytest
import yaml
from shared.documented import ROOT, SITE

import dofkit
from dofkit.classification.arguments import arguments
from dofkit.interface.explanations import all_explanations
from dofkit.report import ConstraintEntry, Report
from dofkit.scene.constraints import TYPES
from dofkit.site.building import SETTINGS, settings
from dofkit.site.gallery import ShownScene, folders, gallery_pages, in_a_line, shown_scene
from dofkit.site.markdown import prose
from dofkit.site.reference_pages import (
    FOLDER,
    GLOSSARY,
    THEOREMS,
    command_pages,
    commands,
    constraint_pages,
    readme_page,
    report_pages,
    scene_of,
)

DISC = """
coordinates: [x, y, theta, phi]
parameters: {R: positive}
constraints: ["dy = R cos(theta) dphi", "dx = -R sin(theta) dphi"]
"""


WRITTEN_GLOSSARY = (SITE / GLOSSARY).read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def disc() -> ShownScene:
    return shown_scene("disc", "l6", DISC)


@pytest.fixture(scope="module")
def types(disc: ShownScene) -> dict[str, str]:
    return {page.path: page.text for page in constraint_pages([disc])}


@pytest.mark.parametrize("kind", TYPES)
def test_every_type_has_its_page_with_equations_a_picture_and_a_scene(types: dict[str, str], kind: str) -> None:
    page, cls = types[f"{FOLDER}/{kind}.md"], TYPES[kind]
    assert (cls.__doc__ or "").strip(), "its docstring says its equations"
    assert cls.words().examples, "an example is its scene"
    assert prose((cls.__doc__ or "").split("\n")[0])[:40] in page
    assert types[f"{FOLDER}/{kind}.svg"].startswith("<svg")
    assert scene_of(cls) in page
    assert dofkit.loads(scene_of(cls)).constraints
    assert all(f"| `{field}` |" in page for field in cls.model_fields)
    assert f"[`{kind}`]({kind}.md)" in types[f"{FOLDER}/index.md"]


def test_a_type_names_the_scenes_of_the_catalog_that_have_it(types: dict[str, str]) -> None:
    assert "../../gallery/l6.md#disc" in types[f"{FOLDER}/equation.md"]
    assert "In the catalog" not in types[f"{FOLDER}/cam.md"]


def test_every_field_and_verdict_is_reported_of() -> None:
    glossary = next(page.text for page in report_pages(WRITTEN_GLOSSARY) if page.path == GLOSSARY)
    assert all(f"| `{field}` |" in glossary for field in {*Report.model_fields, *ConstraintEntry.model_fields})
    assert all(f"| `{v}` |" in glossary for v in ("proved", "probable", "numeric", "undecided"))
    assert all(prose(key) in glossary for key in arguments())
    explained = [word for word in all_explanations() if word.kind in ("term", "feedback code")]
    assert {word.kind for word in explained} == {"term", "feedback code"}
    assert all(prose(word.word) in glossary or f"`{word.word}`" in glossary for word in explained)
    assert glossary.index("## Terms") < glossary.index("## Feedback codes") < glossary.index("## How dofkit writes")


def test_every_public_name_is_in_the_python_reference() -> None:
    named = set(re.findall(r"^::: dofkit\.(\w+)$", (SITE / "reference" / "python.md").read_text("utf-8"), re.MULTILINE))
    assert named == set(dir(dofkit)) - {"__version__"}


def test_every_theorem_has_its_place_and_no_table_is_left() -> None:
    told = next(page.text for page in report_pages(WRITTEN_GLOSSARY) if page.path == THEOREMS)
    keys = re.findall(r"^\| `(\w+)` \|", (ROOT / "dofkit" / "THEOREMS.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert len(keys) > 40
    assert all(f"### {key} {{#{key.lower()}}}" in told for key in keys)
    assert "|---" not in told


def test_every_command_and_option_is_reported_of() -> None:
    (page,) = command_pages()
    names = [path for path, _ in commands()]
    assert {"dofkit classify", "dofkit catalog", "dofkit export gradescope"} <= set(names)
    assert all(f"## {name}\n" in page.text for name in names)
    assert "`--fail-on WHAT,...`" in page.text
    assert "Default: `auto`." in page.text


def test_an_answer_in_a_line() -> None:
    def told(*constraints: str) -> str:
        return in_a_line(dofkit.classify({"coordinates": ["x", "y"], "constraints": list(constraints)}))

    assert told("x = t", "2 x = 2 t") == "f = 1, holonomic, rheonomic, redundant: c2 (proved)"
    assert told("x = 1", "x = 2").startswith("inconsistent: c1, c2 (")


def test_the_gallery_shows_a_scene_with_its_answer(disc: ShownScene) -> None:
    pages = {page.path: page.text for page in gallery_pages([disc], folders())}
    assert set(pages) == {"gallery/index.md", "gallery/l6.md", "gallery/disc.svg", "gallery/disc-small.svg"}
    assert "<text" not in pages["gallery/disc-small.svg"]
    assert "f = 4, velocity freedom 2, non-holonomic, scleronomic (proved)" in pages["gallery/l6.md"]
    assert 'href="l6.html#disc"' in pages["gallery/index.md"]
    assert "Lecture 6" in pages["gallery/index.md"]


def test_the_navigation_holds_every_written_page_and_every_type(disc: ShownScene) -> None:
    listed = set(re.findall(r"[\w/-]+\.md", str(settings([disc])["nav"])))
    assert {str(path.relative_to(SITE)) for path in SITE.rglob("*.md")} <= listed
    assert {f"{FOLDER}/{kind}.md" for kind in TYPES} <= listed
    assert {"gallery/index.md", "gallery/l6.md", THEOREMS, "about/limits.md"} <= listed


def test_nothing_is_fetched_from_anywhere() -> None:
    found = yaml.safe_load(SETTINGS.read_text(encoding="utf-8"))
    assert found["theme"]["font"] is False
    assert not re.search(r"https?://", SETTINGS.read_text(encoding="utf-8"))


def test_the_readme_is_the_first_page() -> None:
    assert readme_page("# T\n\n[d](dofkit/site/pages/d.md)\n") == ("index.md", "# T\n\n[d](d.md)\n")


def test_the_site_is_not_in_the_wheel_and_its_extra_says_what_builds_it() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    assert project["tool"]["hatch"]["build"]["targets"]["wheel"]["exclude"] == ["dofkit/site"]
    needed = project["project"]["optional-dependencies"]["docs"]
    assert all(">=" in name for name in needed if not name.startswith("dofkit["))
