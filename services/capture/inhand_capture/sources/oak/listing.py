"""Attached cameras as a person reads them, with the settings to write for them."""

from collections.abc import Sequence

from inhand_capture.sources.oak.devices import Attached, nobody

ONE, SEVERAL = "front", "camera_{}"
"""Names of the tables: of a single camera, and of one of several."""


def listing(cameras: Sequence[Attached]) -> str:
    """One line for each camera, and one table for each that this user may open."""
    if not cameras:
        return nobody()
    lines = [_line(camera) for camera in cameras]
    usable = [camera for camera in cameras if not camera.forbidden]
    if usable:
        lines += ["", "# In the rig's settings:"]
    for number, camera in enumerate(usable, 1):
        name = ONE if len(usable) == 1 else SEVERAL.format(number)
        lines += [
            f"[capture.{name}]",
            'source = "oak"',
            f"[capture.{name}.options]",
            f'serial = "{camera.serial}"' if camera.serial else f'ip = "{camera.place}"',
            "",
        ]
    return "\n".join(lines).rstrip()


def _line(camera: Attached) -> str:
    place = camera.place if camera.by_network else f"USB port {camera.place}"
    return f"{camera.serial or '(no serial)'} at {place}: {camera.unusable or 'free'}"
