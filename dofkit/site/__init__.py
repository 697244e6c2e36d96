"""The site: what a person reads about dofkit, and tries in a browser.

In a checkout ``pip install '.[docs]' && python -m dofkit.site`` writes `build/site`. The folder is not part of the
wheel.

What a person wrote stands in `pages/`. The rest is generated from the package itself, so that it cannot be out of date.

Mechanisms, in the order of the work
    1. `reference_pages`: a page for each constraint type from its class; glossary, theorems and commands from the
       tables of fields, verdicts and arguments and from the help of the commands. `gallery`: the catalog's pictures and
       reports.
    2. `bench`: the page where a scene is typed and answered. `runtime` assembles what runs dofkit in a browser, and
       `browser` holds the functions that are called there.
    3. `markdown` escapes prose and fills in `templates/`; `building` runs MkDocs over all of it.
"""
