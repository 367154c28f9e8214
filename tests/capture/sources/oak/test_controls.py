"""What a camera is told of exposure, focus, white balance and light."""

from datetime import timedelta

import pytest
from inhand_capture.sources.oak.controls import set_automatic, set_controls, set_infrared
from inhand_capture.sources.oak.library import dai
from inhand_capture.sources.oak.options import OakOptions
from inhand_runtime.source import SourceError

COMMAND = dai.CameraControl.Command


def _set(**options: object) -> "dai.CameraControl":
    control = dai.CameraControl()
    set_controls(control, OakOptions(**options))
    return control


def test_what_is_fixed_is_manual() -> None:
    control = _set(exposure_us=8000, iso=400, focus=120, white_balance_k=4000)
    assert control.getExposureTime() == timedelta(microseconds=8000)
    assert control.getSensitivity() == 400
    assert control.getLensPosition() == 120
    assert not control.getCommand(COMMAND.AE_AUTO)


def test_nothing_is_said_of_what_is_not_fixed() -> None:
    control = _set()
    for command in (COMMAND.AE_AUTO, COMMAND.AE_MANUAL, COMMAND.AWB_MODE):
        assert not control.getCommand(command)


def test_what_was_fixed_can_be_left_to_the_camera_again() -> None:
    control = dai.CameraControl()
    set_automatic(control, ["exposure_us", "white_balance_k", "focus"])
    assert control.getCommand(COMMAND.AE_AUTO)
    assert control.getCommand(COMMAND.AWB_MODE)


class Lamps:
    """A device with a dot projector alone."""

    def __init__(self) -> None:
        self.powers: list[tuple[str, float]] = []

    def setIrLaserDotProjectorIntensity(self, power: float) -> bool:  # noqa: N802
        self.powers.append(("dots", power))
        return True

    def setIrFloodLightIntensity(self, power: float) -> bool:  # noqa: N802
        self.powers.append(("flood", power))
        return False


def test_lamps_are_switched_on_and_off_again() -> None:
    lamps = Lamps()
    set_infrared(lamps, OakOptions(ir_dots=0.5))
    set_infrared(lamps, OakOptions())
    assert [power for lamp, power in lamps.powers if lamp == "dots"] == [0.5, 0.0]


def test_a_lamp_that_is_not_there_is_told() -> None:
    with pytest.raises(SourceError, match=r"no lamp for options\.ir_flood: leave it out"):
        set_infrared(Lamps(), OakOptions(ir_flood=0.2))
