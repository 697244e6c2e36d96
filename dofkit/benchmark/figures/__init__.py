"""The figures of a run. Needs matplotlib, which is imported when the first of them is drawn."""
