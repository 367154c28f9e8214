"""What somebody truly achieved in a simulation."""

from dataclasses import dataclass, field


@dataclass(frozen=True)
class TrueAchievement:
    """An act from ``start_s`` to ``end_s``, seconds from the first frame, with its amounts."""

    kind: str
    start_s: float
    end_s: float
    amounts: dict[str, float] = field(default_factory=dict)
