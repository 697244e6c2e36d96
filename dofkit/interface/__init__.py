"""The command line: files in, lines and an exit status out."""
