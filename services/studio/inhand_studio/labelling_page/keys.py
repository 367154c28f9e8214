"""The keys of the labelling page; docs/studio.md has the same table.

W, A, S, D, Q, E and the arrows turn the scene in the browser, and are not used here.
"""

from typing import NamedTuple


class Key(NamedTuple):
    """A key, with what is held beside it, if anything; the ``name`` of what it does, and a line
    about it."""

    key: str
    modifier: str | None
    name: str
    about: str


_STEPS = (
    ("J", "left", "left"),
    ("L", "right", "right"),
    ("I", "up", "up"),
    ("K", "down", "down"),
    ("U", "nearer", "nearer"),
    ("O", "farther", "farther"),
)
_TURNS = (
    ("T", "pitch_up", "about x, one way"),
    ("G", "pitch_down", "about x, the other"),
    ("F", "yaw_left", "about y, one way"),
    ("H", "yaw_right", "about y, the other"),
    ("R", "roll_left", "about z, one way"),
    ("Y", "roll_right", "about z, the other"),
)


def _fine(name: str, held: str | None) -> str:
    return name if held is None else f"fine_{name}"


KEYS: tuple[Key, ...] = (
    Key("Z", None, "back", "One frame back"),
    Key("X", None, "on", "One frame on"),
    Key("Z", "shift", "back_ten", "Ten frames back"),
    Key("X", "shift", "on_ten", "Ten frames on"),
    Key("pageup", None, "previous_keyframe", "To the keyframe before"),
    Key("pagedown", None, "next_keyframe", "To the keyframe after"),
    Key("home", None, "first", "To the first frame"),
    Key("end", None, "last", "To the last frame"),
    Key("P", None, "play", "Play, and stop"),
    Key("N", None, "set_keyframe", "Set a keyframe at the shown pose, refined or not"),
    Key("delete", None, "delete_keyframe", "Delete the keyframe"),
    Key("M", None, "mark_absent", "Mark the object as absent"),
    Key("C", None, "copy_previous", "Copy the pose of the keyframe before"),
    Key("Z", "cmd/ctrl", "undo", "Undo"),
    Key("Y", "cmd/ctrl", "redo", "Redo"),
    Key("Z", "cmd/ctrl+shift", "redo", "Redo"),
    *(
        Key(key, held, _fine(name, held), f"Move {about}, {'1 mm' if held else '1 cm'}")
        for held in (None, "shift")
        for key, name, about in _STEPS
    ),
    *(
        Key(key, held, _fine(name, held), f"Turn {about}, {'1°' if held else '10°'}")
        for held in (None, "shift")
        for key, name, about in _TURNS
    ),
    Key("B", None, "snap", "Bring the object to the image"),
    Key("7", None, "start_placing", "Place the object by one click"),
    Key("8", None, "start_clicks", "Start by three clicks"),
    Key("escape", None, "end_clicks", "End the clicks"),
    Key("6", None, "estimate", "Take the tracker's estimate"),
    Key("9", None, "assist", "Refine between keyframes"),
    Key("0", None, "worst", "To the frame that is doubted most"),
    Key("V", None, "zoom", "Zoom to the object, and back"),
    Key("1", None, "look_colour", "Look at colours"),
    Key("2", None, "look_depth", "Look at depths"),
    Key("3", None, "look_3d", "Look at the scene in 3-D"),
)


def described() -> str:
    """Return the keys as a table of Markdown."""
    lines = ["| key | does |", "|---|---|"]
    lines += [f"| {_spelled(one)} | {one.about} |" for one in KEYS]
    return "\n".join(lines)


def _spelled(one: Key) -> str:
    held = "" if one.modifier is None else one.modifier.replace("cmd/ctrl", "ctrl") + " + "
    return held + (one.key if len(one.key) == 1 else one.key.replace("page", "page "))
