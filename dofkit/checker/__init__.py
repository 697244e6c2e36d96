"""The checker: a second, small program that rechecks every claim of a certificate from the scene's text alone."""
