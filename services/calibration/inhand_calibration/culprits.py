"""Which of several cameras is wrong, where they disagree by twos."""

from collections.abc import Iterable


def culprits(pairs: Iterable[tuple[str, str, bool]]) -> frozenset[str]:
    """Return the cameras that disagree with every other, of pairs with whether they disagree.

    None where no two agree: then nobody can tell which of two is wrong.
    """
    said = list(pairs)
    agreeing = {name for *both, off in said if not off for name in both}
    disagreeing = {name for *both, off in said if off for name in both}
    return frozenset(disagreeing - agreeing if agreeing else ())
