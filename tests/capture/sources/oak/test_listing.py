"""What `inhand capture --list` shows."""

import tomllib

import pytest
from inhand_capture.settings import CaptureSettings
from inhand_capture.sources.oak.devices import attached
from inhand_capture.sources.oak.library import dai
from inhand_capture.sources.oak.listing import listing
from inhand_capture.sources.oak.options import OakOptions
from running_rig import RunningRig

SUCCESS = dai.XLinkError_t.X_LINK_SUCCESS
FORBIDDEN = dai.XLinkError_t.X_LINK_INSUFFICIENT_PERMISSIONS


def _camera(place: str, serial: str, status: "dai.XLinkError_t" = SUCCESS, free: bool = True):
    info = dai.DeviceInfo(
        place,
        serial,
        dai.XLinkDeviceState.X_LINK_UNBOOTED,
        dai.XLinkProtocol.X_LINK_USB_VSC,
        dai.XLinkPlatform.X_LINK_MYRIAD_X,
        status,
    )
    return attached(info, free=free)


def _settings(text: str) -> dict[str, CaptureSettings]:
    tables = tomllib.loads(text.partition("# In the rig's settings:")[2])["capture"]
    return {name: CaptureSettings(**table) for name, table in tables.items()}


def test_what_to_write_for_a_camera_is_valid_and_means_it() -> None:
    text = listing([_camera("1.2", "L1")])
    assert text.splitlines()[0] == "L1 at USB port 1.2: free"
    (front,) = _settings(text).values()
    assert front.source == "oak"
    assert OakOptions(**front.options).serial == "L1"


def test_each_of_several_has_its_table() -> None:
    text = listing([_camera("1.2", "L1"), _camera("1.3", "R1", free=False)])
    assert "R1 at USB port 1.3: another process uses it" in text
    settings = _settings(text)
    serials = {name: table.options["serial"] for name, table in settings.items()}
    assert serials == {"camera_1": "L1", "camera_2": "R1"}


def test_one_that_may_not_be_opened_has_its_mend_and_no_table() -> None:
    text = listing([_camera("1.2", "", status=FORBIDDEN, free=False)])
    assert "(no serial) at USB port 1.2: this user may not open it" in text
    assert "[capture" not in text


@pytest.mark.long
def test_the_verb_says_that_no_camera_is_attached(rig: RunningRig) -> None:
    done = rig.done("capture", "--list")
    assert done.popen.returncode == 0
    assert "no OAK camera is attached: plug it in" in done.stdout
