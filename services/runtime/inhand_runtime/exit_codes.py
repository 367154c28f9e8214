"""What the exit code of every Inhand process means."""

DONE = 0
FAILED = 1
"""The work failed, or a promise was broken (a lost frame, say)."""
WRONG_USAGE = 2
"""Arguments or settings are wrong; starting again cannot help."""
INTERRUPTED = 130
"""Somebody pressed Ctrl-C."""
