"""The theorems that decide: each key that the code names is a line of `THEOREMS.md`, and each line names its files.

``python tests/whole/test_theorems.py`` writes the column "where used" again.
"""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from functools import cache

from shared.sources import PACKAGE, SOURCES, one_process, tree_of

from dofkit.checker.curves import LEAST, MOST
from dofkit.checker.verification import RULES

pytestmark = one_process
TABLE = PACKAGE / "THEOREMS.md"
#: A key in a comment or a docstring: a name in brackets that is no subscript, and no word in capitals for a field.
KEY = re.compile(r"(?<![\w\]])\[([A-Z][A-Za-z]+\d{1,4}|[A-Z]+[a-z][A-Za-z]*)\]")
IN_CERTIFICATES = re.compile(r"\(in certificates: ([^)]+)\)")
ROW = re.compile(r"^\| `(\w+)` \| ([^|]+) \| ([^|]+) \| ([^|]+) \| ([^|]*) ?\|$", re.MULTILINE)


def remarks(name: str) -> str:
    """The comments and docstrings of a module: what follows a # in any line, and what ``ast`` takes for docstrings."""
    comments = re.findall(r"#.*", SOURCES[name].read_text(encoding="utf-8"))
    nodes = (ast.Module, ast.ClassDef, ast.FunctionDef)
    docstrings = [ast.get_docstring(node) or "" for node in ast.walk(tree_of(name)) if isinstance(node, nodes)]
    return "\n".join([*comments, *docstrings])


@cache
def uses() -> dict[str, list[str]]:
    """The files that hold each key."""
    files: defaultdict[str, list[str]] = defaultdict(list)
    for name in SOURCES:
        for key in sorted(set(KEY.findall(remarks(name)))):
            files[key].append(name)
    return dict(files)


@cache
def rows() -> dict[str, tuple[str, str, str, str]]:
    """Author, year, statement and where used, of every key."""
    matches = ROW.findall(TABLE.read_text(encoding="utf-8"))
    assert len({key for key, *_ in matches}) == len(matches), "a key stands twice"
    return {key: (author, year, statement, where) for key, author, year, statement, where in matches}


def test_every_line_of_the_table_is_read() -> None:
    lines = [line for line in TABLE.read_text(encoding="utf-8").splitlines() if line.startswith("| `")]
    assert len(lines) == len(rows())


def test_every_key_in_the_code_is_in_the_table() -> None:
    assert not set(uses()) - set(rows())


def test_every_key_in_the_table_is_used() -> None:
    assert not set(rows()) - set(uses())


def test_where_a_theorem_is_used_is_reported() -> None:
    """Each path exists and holds the key, and no file that holds it is left out."""
    found = uses()
    assert {key: re.findall(r"`([^`]+)`", where) for key, (*_, where) in rows().items()} == found


def test_rows_name_the_rules_of_certificates_that_rest_on_them() -> None:
    """Each rule named is one of the checker's; the others follow by definition, by identity or by count."""
    named = {
        rule for *_, text, _ in rows().values() for told in IN_CERTIFICATES.findall(text) for rule in told.split("`")
    }
    named -= {"", ", "}
    known = {rule for _, rule in RULES} | set(MOST) | set(LEAST) | {"span"}
    assert named <= known
    assert known - named == {
        *("squeeze", "count", "rank", "conflict", "integrals"),  # by bounds, by counting, by arithmetic, by other rules
        *("finite", "inequality", "timeless", "time-dependent", "not exact"),  # by definition, at a point
    }


def test_a_theorem_has_an_author_a_year_and_one_sentence() -> None:
    for key, (author, year, statement, _) in rows().items():
        assert author[0].isupper(), key
        assert re.fullmatch(r"\d{4}(; \d{4})*", year), key
        assert statement.endswith("."), key
        assert not re.search(r"[a-z]\. [A-Z]", statement), key
        number = re.search(r"\d{4}$", key)
        assert number is None or number[0] in year, key


def written() -> str:
    """The table with the column "where used" as the code has it."""
    found = uses()

    def row(match: re.Match[str]) -> str:
        key, *cells, _ = match.groups()
        return " | ".join([f"| `{key}`", *cells, ", ".join(f"`{path}`" for path in found.get(key, []))]) + " |"

    return ROW.sub(row, TABLE.read_text(encoding="utf-8"))


if __name__ == "__main__":
    TABLE.write_text(written(), encoding="utf-8")
