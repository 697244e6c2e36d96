"""Property tests draw the same examples on every run, so that a failure is a change of the code and not luck."""

from hypothesis import settings

settings.register_profile("steady", derandomize=True, deadline=None, print_blob=True)
settings.load_profile("steady")
