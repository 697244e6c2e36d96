"""A notebook of ten cells, as a newcomer would write it."""

from __future__ import annotations

CELLS = (
    "import dofkit\nscene = dofkit.load('disc-rolling-on-plane')\nscene",
    "report = dofkit.classify(scene)\nreport",
    "report.constraints[0]",
    "print(report)",
    "dofkit.classify('four-bar-linkage')",
    "dofkit.classify({'particles': ['A', 'B'], 'dimension': 2, 'constraints': [\n"
    "    {'type': 'link', 'between': ['A', 'B'], 'length': 1}, 'x_A^2 + y_A^2 = 1/4', 'x_B = 3', 'y_B >= 0']})",
    "dofkit.lagrange('trolley-pendulum', linearize=True)",
    "dofkit.linkage([('A', 'B'), ('B', 'C'), ('C', 'D'), ('D', 'A'), ('A', 'C'), ('B', 'D')], 2)",
    "sheet = {'title': 'Sheet', 'problems': [{'id': 'disc', 'title': 'Disc', 'scene': 'disc-rolling-on-plane',\n"
    "    'questions': [{'id': 'f', 'ask': 'dof', 'points': 2}, {'id': 'k', 'ask': 'k'}]}]}\n"
    "dofkit.grade(sheet, {'student': 'ada', 'answers': {'disc': {'f': 2, 'k': 0}}})",
    "dofkit.classify({'coordinates': ['x', 'y'], 'constraints': ['x dy + y dx = 0']})",
)
