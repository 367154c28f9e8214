"""Who of a rig is missing, and what is wrong with those who live."""

from collections.abc import Iterable

from inhand_runtime.roll import Instance, Roll

from inhand.looking import UNREACHED
from inhand.stopped import Stopped, stopped_lines


def problems(
    roll: Roll, expected: Iterable[Instance] = (), stopped: Iterable[Stopped] = ()
) -> list[str]:
    """What is wrong, a line each: who is missing or hangs, and what each says is wrong.

    ``stopped`` are processes of this machine, which cannot show that they are there.
    """
    missing = set(expected) - roll.living().keys()
    standing = stopped_lines(stopped, missing, roll.silent())
    lines = [
        f"{service} {name} is missing: {UNREACHED}"
        for service, name in sorted(missing - set(standing.values()))
    ]
    return [*lines, *standing, *roll.troubles()]
