"""The numbers by which Home Assistant is reached."""

from dataclasses import dataclass


@dataclass(frozen=True)
class HomeParameters:
    """How long things take, and how much waits."""

    refresh_s: float = 30.0
    """Seconds after which what may expire is sent again, and the store is looked at again."""
    keep_alive_s: int = 15
    """Seconds without a word after which broker and daemon take each other as gone (half as long
    again); a connection is waited for as long."""
    answer_s: float = 10.0
    """Seconds in which a broker must confirm a message."""
    farewell_s: float = 2.0
    """Seconds in which it must confirm the last, when the daemon stops."""
    first_wait_s: float = 1.0
    """Seconds after a failure until the next try; they double with each."""
    longest_wait_s: float = 60.0
    """Seconds at most between two tries."""
    events: int = 256
    """Number of events that wait; the oldest go."""
    events_last_s: float = 60.0
    """Seconds for which an event is news: an automation that comes later would surprise people."""
    commands: int = 32
    """Number of messages from the broker that wait; more are dropped."""
    discovered_s: float = 1.0
    """Seconds that Home Assistant has for an announcement before events of it are sent."""


DEFAULT_HOME = HomeParameters()
