"""Who of a rig lives, as somebody sees it who looks for long."""

from examples import RUNNING
from inhand_runtime.roll import SILENT_AFTER_S, Roll
from msgspec.structs import replace

CAMERA = ("capture", "front")
HEALTH = replace(RUNNING, service="capture", instance="front")


def test_one_that_is_started_again_is_not_said_to_hang_by_what_it_said_before() -> None:
    now_s = [0.0]
    roll = Roll(lambda: now_s[0], patience_s=SILENT_AFTER_S)
    roll.change(*CAMERA, True)
    roll.hear(HEALTH)
    roll.change(*CAMERA, False)
    now_s[0] = 60.0
    roll.change(*CAMERA, True)
    assert roll.living() == {CAMERA: None}
    assert (roll.silent(), roll.troubles()) == ([], [])
    now_s[0] += SILENT_AFTER_S
    assert roll.silent() == [CAMERA]
    assert roll.troubles() == ["capture front hangs, or is stopped: it is there, and says nothing"]
