"""Every number of the gate that can be tuned; where nothing is said it was set by hand."""

from dataclasses import dataclass


@dataclass(frozen=True)
class GateParameters:
    """Decides how long the gate remembers and waits, and how much it takes."""

    fewest_characters: int = 8
    """Number of characters that a password has at the least: with ``failures_an_address`` a
    program tries fewer than three million a year from one address."""
    session_s: float = 12 * 3600.0
    """Seconds until a browser must give the password again."""
    most_sessions: int = 1000
    """Number of browsers that are known at one time; the oldest is forgotten for a further one."""
    window_s: float = 60.0
    """Seconds for which a failed login counts."""
    failures_an_address: int = 5
    """Number of failed logins from one address in the window after which it must wait."""
    failures_in_all: int = 100
    """The same from all addresses together, against a guess that is spread over many."""
    largest_form_bytes: int = 4096
    """Bytes of a login, of which a password is the most."""
    largest_message_bytes: int = 50 << 20
    """Bytes of one message from a browser: what viser 1.1 itself takes at the most."""
    piece_bytes: int = 1 << 16
    """Bytes of an answer that are forwarded at a time."""
    heartbeat_s: float = 60.0
    """Seconds between questions whether a browser is still there; it has half as long to answer,
    which a slow link with a large message under way must keep."""
    closing_s: float = 1.0
    """Seconds that one side has to end a connection that the other has ended."""
    connecting_s: float = 5.0
    """Seconds that the inner server, on this machine, has to take a connection."""
    address_tries: int = 16
    """Number of addresses of this machine that are tried until one can be listened at."""


DEFAULT_GATE = GateParameters()
