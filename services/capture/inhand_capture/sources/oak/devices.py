"""The cameras that are attached, and which of them is meant."""

from collections.abc import Sequence
from dataclasses import dataclass

from inhand_runtime.source import SourceAbsentError, SourceError

from inhand_capture.sources.oak.library import dai
from inhand_capture.sources.oak.options import OakOptions

UDEV_RULE = 'SUBSYSTEM=="usb", ATTRS{idVendor}=="03e7", MODE="0666"'
UDEV_MEND = (
    f"write {UDEV_RULE} into /etc/udev/rules.d/80-movidius.rules, run `udevadm control "
    "--reload-rules && udevadm trigger`, and plug the camera in again"
)

IN_USE = "another process uses it: stop that one (one process for each camera)"
NETWORK = (
    dai.XLinkProtocol.X_LINK_TCP_IP,
    dai.XLinkProtocol.X_LINK_TCP_IP_OR_LOCAL_SHDMEM,
)


@dataclass(frozen=True)
class Attached:
    """A camera that answers: its serial number and place, and what forbids its use, if anything."""

    serial: str
    place: str
    """An IP address, or a USB port such as 1.2."""
    by_network: bool
    info: "dai.DeviceInfo"
    in_use: bool = False
    forbidden: bool = False
    """Whether the user that runs this may not open it."""

    @property
    def unusable(self) -> str | None:
        """Why it cannot be opened now, with the mend; None when it can."""
        if self.forbidden:
            return f"this user may not open it: {UDEV_MEND}"
        return IN_USE if self.in_use else None


def attached_cameras() -> list[Attached]:
    """Every OAK camera at USB and in this network; takes a second."""
    everywhere = dai.XLinkConnection.getAllConnectedDevices(
        dai.XLinkDeviceState.X_LINK_ANY_STATE, False
    )
    free = {info.getDeviceId() for info in dai.Device.getAllAvailableDevices()}
    return [attached(info, free=info.getDeviceId() in free) for info in everywhere]


def attached(info: "dai.DeviceInfo", *, free: bool) -> Attached:
    """Say of a device that depthai lists what it is, and why it cannot be used."""
    return Attached(
        serial=info.getDeviceId(),
        place=info.name,
        by_network=info.protocol in NETWORK,
        info=info,
        in_use=not free,
        forbidden=info.status == dai.XLinkError_t.X_LINK_INSUFFICIENT_PERMISSIONS,
    )


def choose(cameras: Sequence[Attached], options: OakOptions) -> "dai.DeviceInfo":
    """Return the device that the settings mean.

    Raises SourceAbsentError when it is not there, not free or not allowed, and SourceError when it
    takes a setting to say which is meant.
    """
    meant = [camera for camera in cameras if _is_meant(camera, options)]
    if not meant and options.ip is not None:
        return dai.DeviceInfo(options.ip)  # in another network no search finds it
    if not meant:
        raise SourceAbsentError(_nobody_meant(cameras, options))
    if len(meant) > 1:
        serials = ", ".join(camera.serial for camera in meant)
        raise SourceError(f"several cameras are attached: set options.serial to one of: {serials}")
    camera = meant[0]
    if camera.unusable is not None:
        who = f"the camera {camera.serial} at {camera.place}"
        raise SourceAbsentError(f"{who} cannot open: {camera.unusable}")
    return camera.info


def _is_meant(camera: Attached, options: OakOptions) -> bool:
    if options.serial is not None:
        return camera.serial == options.serial
    if options.ip is not None:
        return camera.by_network and camera.place == options.ip
    if options.usb_port is not None:
        return not camera.by_network and camera.place == options.usb_port
    return True


def nobody() -> str:
    """The line for a host without any camera."""
    return "no OAK camera is attached: plug it in, or check its cable and power"


def _nobody_meant(cameras: Sequence[Attached], options: OakOptions) -> str:
    if not cameras:
        return nobody()
    wish = next(
        f"{name} {value}"
        for name in ("serial", "usb_port")
        if (value := getattr(options, name)) is not None
    )
    others = ", ".join(f"{camera.serial} at {camera.place}" for camera in cameras)
    return f"no OAK camera with {wish} is attached; there are: {others}"
