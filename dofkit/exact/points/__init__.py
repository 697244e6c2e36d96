"""Points over GF(p), the rationals, balls and series, at which programs run."""
