"""At the drawing: what is allowed to first order, and which of it moves."""
