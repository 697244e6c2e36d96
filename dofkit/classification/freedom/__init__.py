"""The blocks of a system answered, over the branches of its relations."""
