"""Many submissions: in order or in workers, kept in a journal so that a run goes on after a kill."""
