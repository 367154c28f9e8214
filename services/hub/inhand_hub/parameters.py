"""Numbers that were chosen for certificates and for the hub."""

from dataclasses import dataclass


@dataclass(frozen=True)
class HubParameters:
    """How long certificates last, and how the hub looks after its list of members."""

    member_days: int = 365
    """Days for which the certificate of a member, or of the hub, is valid: a yearly renewal."""
    authority_days: int = 3650
    """Days for which the authority is valid; with its end a site is made anew."""
    backdated_s: float = 3600.0
    """Seconds before its making from which on a certificate is valid: clocks of hosts differ."""
    suffix_bytes: int = 4
    """Random bytes at the end of a common name: a name that returns has no former certificate."""
    warned_days: int = 30
    """Days before the end of a certificate from which on the hub asks for its renewal."""
    poll_s: float = 0.5
    """Seconds between two looks at the list of members."""
    links_of_one: int = 32
    """Links of one certificate beyond which the hub says so: a member is a process, and the few
    verbs that somebody runs beside it with the same settings."""
    waiting: int = 128
    """Files and connections that are open, and no links, beyond which the hub says so: some twenty
    are its own, and a member's becomes a link within milliseconds."""
    look_s: float = 2.0
    """Seconds between two looks at who is connected."""
    warned_every_s: float = 3600.0
    """Seconds between two looks at the days that certificates have left."""


DEFAULT_HUB = HubParameters()
