"""Many scenes: in workers here or in a cluster, in order, kept in a folder so that a run goes on after a kill."""
