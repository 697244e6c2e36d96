"""What a person writes, read with every fault in its place, and made into a `System`."""
