"""What can be wrong with a key or a message from outside."""


class MessageError(ValueError):
    """Bytes that are no valid message of the expected type."""


class KeyFormatError(ValueError):
    """A key, or a name in it, that does not follow ``{realm}/@v1/{rig}/{stream}/{name}``."""


class UnknownVersionError(KeyFormatError):
    """A key or an encoding of a version that this release does not read."""
