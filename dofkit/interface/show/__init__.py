"""What a person reads: how do a report, equations of motion, a scene or a fault look at a terminal and in HTML?

`report`, `motion` and `drawn` turn a value into a `Sheet` (`sheet`): facts, then sections of remarks and tables.
`assurance` tells how certain a report is and why. `terminal` writes a sheet as lines, by rich; `page` as HTML with
MathML. `faults` prints the faults of a file, `decimals` restores the decimals of a scene in formulas, and `drawn`
chooses the sheet of any value that `print` or a notebook shows.
"""
