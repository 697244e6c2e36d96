"""The documentation as a site: in a checkout `pip install '.[docs]' && python -m dofkit.site` writes `build/site`.

What a person wrote stands in `site/pages/`; the rest is told by the package itself: every constraint type by its
class, every field, verdict, argument and command by its own help, every scene of the catalog by its picture and its
report. The folder is not part of the wheel.
"""
