"""The documentation as a site: in a checkout `pip install '.[docs]' && python -m dofkit.site` writes `build/site`.

What a person wrote stands in `pages/`. The rest is generated from the package itself: `constraint_pages` from the
classes of the constraint types, `command_pages` from the help of the commands, `report_pages` (the glossary and the
theorems) from the tables of fields, verdicts and arguments, `gallery_pages` from the catalog's pictures and reports,
`readme_pages` from the README. `shown_scenes` keeps pictures and answers between builds, `markdown` escapes prose,
and `building` runs MkDocs over all of it. The folder is not part of the wheel.
"""
