"""Numbers of things, and others' words, in sentences that a person reads."""


def counted(number: int, thing: str, things: str | None = None) -> str:
    """Return the number with its noun: ``1 message``, ``2 messages``, ``12,000 keys``.

    ``things`` is the plural where it is not ``thing`` with an s.
    """
    return f"{number:,} {thing if number == 1 else things or thing + 's'}"


def sized(count: int) -> str:
    """Return a number of bytes as people read it: ``1.5 MB``, ``20.0 GB``."""
    return f"{count / 1e9:.1f} GB" if count >= 1e9 else f"{count / 1e6:.1f} MB"


def printable(text: str) -> str:
    """Return what others wrote as one line that does nothing to a terminal or a log: characters
    that are none to be seen, as line ends and those that begin a terminal's commands, are written
    as ``\\x1b``."""
    return "".join(one if one.isprintable() else ascii(one)[1:-1] for one in text)
