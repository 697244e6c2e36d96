"""What a person reads: how do a report, a motion, a scene or a fault look at a terminal and in a page?

`report`, `motion` and `drawn` turn a value into a `Sheet` (`sheet`): facts, then sections of remarks and tables.
`assurance` says how certain a report is and why. `terminal` writes a sheet as lines, by rich; `page` as HTML with
MathML. `faults` prints what is wrong with a file, `decimals` gives numbers back as the
scene wrote them, and `drawn` chooses the sheet of any value that `print` or a notebook shows.
"""
