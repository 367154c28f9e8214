"""What is wrong with a camera that gives pictures all the same."""

from inhand_capture.sources.oak.library import dai
from inhand_capture.sources.oak.options import OakOptions
from inhand_capture.sources.oak.parameters import OAK

SLOW = (dai.UsbSpeed.LOW, dai.UsbSpeed.FULL, dai.UsbSpeed.HIGH)


def link_trouble(speed: "dai.UsbSpeed", options: OakOptions) -> str | None:
    """Say that a link of this speed cannot carry what the settings ask for; None when it can."""
    needed = bytes_per_second(options)
    if speed not in SLOW or needed <= OAK.usb2_bytes_per_second:
        return None
    width, height = options.pixels
    return (
        f"the camera is connected by USB 2, which carries {OAK.usb2_bytes_per_second / 1e6:.0f} "
        f"MB/s, and {width} × {height} at {options.frame_rate:g} frames a second take "
        f"{needed / 1e6:.0f}: use a USB 3 cable and port, or a smaller options.size or frame_rate"
    )


def heat_trouble(celsius: float) -> str | None:
    """Say that the chip is too hot; None when it is not."""
    if celsius < OAK.hot_celsius:
        return None
    return (
        f"the camera's chip is hotter than {OAK.hot_celsius:.0f} °C, where frames begin to fail: "
        "let air reach it, or lower options.frame_rate"
    )


def pace_trouble(given: int, missed: int) -> str | None:
    """Say that too many of the device's frames are missing; None when few are."""
    if missed <= OAK.most_missed * (given + missed):
        return None
    return (
        f"only {given} of the camera's last {given + missed} frames came through: this host or the "
        "link is too slow; lower options.frame_rate or options.size"
    )


def bytes_per_second(options: OakOptions) -> float:
    """What colour and depth take of the link."""
    width, height = options.pixels
    colour = OAK.jpeg_bytes_per_pixel if options.mjpeg else 3.0
    return width * height * (colour + 2.0) * options.frame_rate
