"""Numbers of things in sentences that a person reads."""


def counted(number: int, thing: str, things: str | None = None) -> str:
    """Return the number with its noun: ``1 message``, ``2 messages``, ``12,000 keys``.

    ``things`` is the plural where it is not ``thing`` with an s.
    """
    return f"{number:,} {thing if number == 1 else things or thing + 's'}"
