"""Who of a rig lives, as somebody sees it who looks for long."""

from examples import RUNNING
from inhand_runtime.roll import SILENT_AFTER_S, Roll
from inhand_schemas.messages import TopicHealth
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


def test_what_is_said_for_one_that_does_not_live_is_forgotten() -> None:
    roll = Roll()
    roll.hear(replace(HEALTH, service="hub"))
    roll.change("hub", "front", True)
    assert roll.living() == {("hub", "front"): None}
    for number in range(100):
        roll.hear(replace(HEALTH, service=f"service_{number}"))
    assert len(roll._heard) == 0


def test_what_another_says_does_nothing_to_a_terminal() -> None:
    roll = Roll()
    roll.change(*CAMERA, True)
    evil = "\x1b[2J\rall is well\nWRONG: nothing"
    traffic = {f"rgbd/\x1b[31m{evil}": TopicHealth(published=1, rate_hz=1.0)}
    roll.hear(replace(HEALTH, troubles=(evil,), topics=traffic))
    roll.change("capture", "back", True)
    roll.hear(replace(HEALTH, instance="back", topics=traffic))
    lines = roll.troubles()
    assert len(lines) == 2
    assert all(line.isprintable() for line in lines)


def test_labels_of_one_object_from_several_cameras_are_no_fault() -> None:
    roll = Roll()
    for name in ("front", "left"):
        roll.change("capture", name, True)
        traffic = TopicHealth(published=1, rate_hz=1.0)
        topics = {f"inhand/@v1/rig/{key}": traffic for key in ("label/mug", "info/front")}
        roll.hear(replace(HEALTH, instance=name, topics=topics))
    (line,) = roll.troubles()
    assert line.startswith("info/front is published by capture front and by capture left")
