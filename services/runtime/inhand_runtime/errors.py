"""Faults that end a daemon or a verb with one clear line."""


class InhandError(Exception):
    """The work failed; the message is one line that says the mend. Exit code 1."""


class SettingsError(InhandError):
    """Wrong usage or settings. Exit code 2."""
