"""From a `System` to a `Report`: freedom, dependence, labels with their reasons, special cases."""
