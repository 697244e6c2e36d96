"""What several methods have in common: the drawing, the equations as written, replies and reports."""
