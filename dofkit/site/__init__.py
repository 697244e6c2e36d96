"""The documentation as a site: in a checkout `pip install '.[docs]' && python -m dofkit.site` writes `build/site`.

What a person wrote stands in `pages/`. The rest is generated from the package itself: `reference_pages` from the
classes of the constraint types (glossary, theorems, commands: from the tables of fields, verdicts and arguments and
from the help of the commands), `gallery` from the catalog's pictures and reports. `markdown` escapes prose and fills in
`templates/`, and `building` runs MkDocs over all of it. `runtime` assembles what runs dofkit in a browser, `bench` the
page that asks it, and `browser` answers there.
The folder is not part of the wheel.
"""
