"""What knows no mathematics: faults, the time allowed, verdicts, documents with their places, killable processes."""
