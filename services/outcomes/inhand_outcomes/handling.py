"""What happens to any thing: taken up, put down, dropped."""

from inhand_outcomes.achievement import Achievement
from inhand_outcomes.thing import Thing
from inhand_outcomes.track import Track


def handling(track: Track, thing: Thing) -> list[Achievement]:
    """Find where a thing was taken up, put down or dropped."""
    return []
