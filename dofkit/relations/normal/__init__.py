"""The normal form of one relation over the reals: its real zero set in branches, or none."""
