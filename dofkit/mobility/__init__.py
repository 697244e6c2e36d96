"""Who is joined to whom and where: pebble games, twists, general and special position, the counts."""
