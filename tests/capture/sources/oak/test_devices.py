"""Which camera is meant, and what a person is told of one that cannot be opened."""

import pytest
from inhand_capture.sources.oak.condition import heat_trouble, link_trouble
from inhand_capture.sources.oak.connection import opening_error
from inhand_capture.sources.oak.devices import Attached, attached, choose
from inhand_capture.sources.oak.library import dai
from inhand_capture.sources.oak.options import OakOptions
from inhand_runtime.source import SourceAbsentError, SourceError

SUCCESS = dai.XLinkError_t.X_LINK_SUCCESS


def _info(
    name: str,
    serial: str,
    status: "dai.XLinkError_t" = SUCCESS,
    protocol: "dai.XLinkProtocol" = dai.XLinkProtocol.X_LINK_USB_VSC,
) -> "dai.DeviceInfo":
    state = dai.XLinkDeviceState.X_LINK_UNBOOTED
    platform = dai.XLinkPlatform.X_LINK_MYRIAD_X
    return dai.DeviceInfo(name, serial, state, protocol, platform, status)


def _camera(name: str, serial: str, *, free: bool = True, **how: object) -> Attached:
    return attached(_info(name, serial, **how), free=free)


LEFT, RIGHT = _camera("1.2", "L1"), _camera("1.3.1", "R1")
FAR = _camera("192.168.1.44", "N1", protocol=dai.XLinkProtocol.X_LINK_TCP_IP)
ALL = (LEFT, RIGHT, FAR)


@pytest.mark.parametrize(
    ("options", "camera"),
    [({"serial": "R1"}, RIGHT), ({"ip": "192.168.1.44"}, FAR), ({"usb_port": "1.2"}, LEFT)],
)
def test_a_camera_is_chosen_by_serial_address_or_port(
    options: dict[str, str], camera: Attached
) -> None:
    assert choose(ALL, OakOptions(**options)) is camera.info


def test_a_single_camera_needs_no_choice() -> None:
    assert choose((LEFT,), OakOptions()) is LEFT.info


def test_a_usb_port_that_looks_like_an_address_is_a_port() -> None:
    port = _camera("1.2.1.4", "P1")
    assert choose((port, FAR), OakOptions(usb_port="1.2.1.4")) is port.info


def test_an_address_that_no_search_finds_is_tried_all_the_same() -> None:
    assert choose((), OakOptions(ip="10.1.2.3")).name == "10.1.2.3"


@pytest.mark.parametrize(
    ("cameras", "options", "line"),
    [
        ((), {}, "no OAK camera is attached: plug it in"),
        ((LEFT,), {"serial": "X9"}, "no OAK camera with serial X9 is attached; there are: L1 at"),
        ((_camera("1.2", "L1", free=False),), {}, "another process uses it: stop that one"),
    ],
)
def test_a_camera_that_is_absent_or_taken_may_come_back(
    cameras: tuple[Attached, ...], options: dict[str, str], line: str
) -> None:
    with pytest.raises(SourceAbsentError, match=line):
        choose(cameras, OakOptions(**options))


def test_several_cameras_need_a_choice() -> None:
    with pytest.raises(SourceError, match=r"set options\.serial to one of: L1, R1, N1"):
        choose(ALL, OakOptions())


def test_a_camera_that_may_not_be_opened_names_the_udev_rule() -> None:
    status = dai.XLinkError_t.X_LINK_INSUFFICIENT_PERMISSIONS
    with pytest.raises(SourceAbsentError, match=r'\{idVendor\}=="03e7".*80-movidius\.rules'):
        choose((_camera("1.2", "L1", status=status, free=False),), OakOptions())


@pytest.mark.parametrize(
    ("said", "kind", "line"),
    [
        ("X_LINK_INSUFFICIENT_PERMISSIONS", SourceAbsentError, "udevadm"),
        ("error message: X_LINK_DEVICE_ALREADY_IN_USE", SourceAbsentError, "another process"),
        ("No available devices (1 connected, but in use)", SourceAbsentError, "another process"),
        (
            "Failed to find device after booting: X_LINK_DEVICE_NOT_FOUND",
            SourceAbsentError,
            "cable",
        ),
        ("something new", SourceError, "cannot open: something new"),
    ],
)
def test_what_depthai_says_at_opening_is_put_in_a_persons_words(
    said: str, kind: type[SourceError], line: str
) -> None:
    error = opening_error(_info("1.2", "L1"), RuntimeError(said))
    assert type(error) is kind
    assert str(error).startswith("the camera L1")
    assert line in str(error)


def test_usb_2_is_a_trouble_only_where_it_is_too_slow() -> None:
    large = OakOptions(size="1280x720")
    assert "use a USB 3 cable" in (link_trouble(dai.UsbSpeed.HIGH, large) or "")
    assert link_trouble(dai.UsbSpeed.SUPER, large) is None
    assert link_trouble(dai.UsbSpeed.HIGH, OakOptions()) is None
    assert link_trouble(dai.UsbSpeed.HIGH, OakOptions(mjpeg=False)) is not None


def test_a_hot_chip_is_a_trouble() -> None:
    assert heat_trouble(79.0) is None
    assert "hotter than 80 °C" in (heat_trouble(81.0) or "")
