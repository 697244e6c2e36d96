"""The graph of rigid links: what is redundant, rigid and what moves, in general position."""
