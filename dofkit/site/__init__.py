"""The site: the documentation of dofkit as web pages, and a page that classifies scenes in a browser.

In a checkout ``pip install '.[docs]' && python -m dofkit.site`` writes `build/site`. The folder is not part of the
wheel.

Hand-written pages are in `pages/`; all others are generated from the package itself, so that they are up to date.

Mechanisms, in the order of the work
    1. `reference_pages`: a page for each constraint type from its class; glossary, theorems and commands from the
       tables of fields, verdicts and arguments and from the help of the commands. `gallery`: the catalog's pictures and
       reports.
    2. `bench`: the page where a scene is typed in and classified. `runtime` assembles the files that run dofkit in a
       browser, and `browser` contains the functions that are called there.
    3. `markdown` escapes prose and fills in `templates/`; `building` runs MkDocs over all of it.
"""
