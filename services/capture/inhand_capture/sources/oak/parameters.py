"""Every number of the OAK driver that can be tuned."""

from dataclasses import dataclass


@dataclass(frozen=True)
class OakParameters:
    """How long a device is waited for, and what it is said to stand."""

    # Waiting (source).
    silence_s: float = 2.0
    """Seconds without a pair of colour and depth after which a device is lost, though nothing was
    raised: links fail silently (luxonis/depthai-core issue 1162)."""
    first_pair_s: float = 15.0
    """Seconds within which a device that was opened gives its first pair."""
    poll_s: float = 0.2
    """Longest wait for a frame at a time, in seconds: then a source that is closed ends."""
    condition_s: float = 5.0
    """Seconds between questions to the device about its temperature, over the same link."""
    queued_frames: int = 8
    """Number of frames of each stream that wait for the host; older ones are dropped there."""

    # Pairing.
    waiting_frames: int = 8
    """Number of frames of each stream that wait for their counterpart; older ones have none."""
    farthest_frames: float = 0.5
    """Time between colour and depth of one moment at the most, in frames: beyond half a frame the
    next one is nearer."""

    # The clock. Frames are stamped by the host's monotonic clock, as depthai maps it.
    usb_clock_ns: int = 200_000
    """Error of depthai's mapping of the device's clock over USB, in nanoseconds, as its makers say;
    only hardware can show it."""
    network_clock_ns: int = 2_500_000
    """The same over a network."""
    quick_reading_ns: int = 20_000
    """Time within which both clocks are read together, nanoseconds: a reading that was interrupted
    is repeated."""
    clock_readings: int = 5
    """Number of attempts at such a reading; the quickest counts."""

    # What a device stands (condition).
    hot_celsius: float = 80.0
    """Temperature of the chip from which on it is said to be too hot: at 81 °C frames fail to come
    (luxonis/depthai-ros issue 768)."""
    usb2_bytes_per_second: float = 30e6
    """What USB 2 carries in practice; its 480 Mbit/s are 60 MB/s before all overhead."""
    most_missed: float = 0.1
    """Share of the device's frames that may be missing before it is said that they are."""
    jpeg_bytes_per_pixel: float = 0.2
    """Bytes of a pixel in a JPEG of the quality below: 0.17 for a smoothed random picture."""
    jpeg_quality: int = 90
    """Quality of the device's JPEG: that of ``inhand_runtime.pixels``."""


OAK = OakParameters()
