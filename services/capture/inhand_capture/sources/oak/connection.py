"""An opened device and its graph: the only place that makes nodes of the device itself."""

import contextlib
from collections.abc import Callable, Collection
from dataclasses import dataclass
from functools import partial

from inhand_runtime.source import SourceAbsentError, SourceError

from inhand_capture.sources.oak.condition import heat_trouble, link_trouble
from inhand_capture.sources.oak.controls import set_automatic, set_controls, set_infrared
from inhand_capture.sources.oak.devices import IN_USE, NETWORK, UDEV_MEND, attached_cameras, choose
from inhand_capture.sources.oak.library import dai
from inhand_capture.sources.oak.options import OakOptions
from inhand_capture.sources.oak.parameters import OAK


@dataclass(frozen=True)
class Connection:
    """A pipeline that is not yet started, its two outputs, and what the device can say.

    ``colour`` gives ImgFrame in RGB888i, or EncodedFrame, and ``depth`` ImgFrame in RAW16, in
    millimetres, aligned to colour. ``troubles`` says by name what is wrong though frames come, and
    ``died`` why the device is gone, if it knows. ``close`` may be called in any state.
    """

    pipeline: "dai.Pipeline"
    colour: "dai.Node.Output"
    depth: "dai.Node.Output"
    description: str
    clock_ns: int
    """Error with which frames are stamped by the host's clock, nanoseconds."""
    control: Callable[[OakOptions, Collection[str]], None]
    """Sets exposure, focus, white balance and light, and what is named automatic; raises
    SourceError."""
    troubles: Callable[[], dict[str, str]]
    died: Callable[[], str | None]
    close: Callable[[], None]


def connect(options: OakOptions) -> Connection:
    """Open the device that the settings mean.

    Raises SourceAbsentError when it is not there, not free or not allowed, and SourceError when it
    cannot be opened otherwise, or cannot do what the settings ask for.
    """
    info = choose(attached_cameras(), options)
    device = _open(info)
    try:
        return _build(device, options)
    except SourceError:
        device.close()
        raise
    except RuntimeError as error:
        device.close()
        raise SourceError(f"the camera cannot do what the settings ask for: {error}") from error


def opening_error(info: "dai.DeviceInfo", error: Exception) -> SourceError:
    """Translate what depthai said when it could not open a device."""
    text, who = str(error), f"the camera {info.getDeviceId() or info.name}"
    if "INSUFFICIENT_PERMISSIONS" in text:
        return SourceAbsentError(f"{who} cannot open: this user may not open it: {UDEV_MEND}")
    if "ALREADY_IN_USE" in text or "in use" in text:
        return SourceAbsentError(f"{who} cannot open: {IN_USE}")
    if "NOT_FOUND" in text or "Cannot find any device" in text or "No available" in text:
        return SourceAbsentError(f"{who} does not answer: check its cable and power")
    return SourceError(f"{who} cannot open: {text}")


def _open(info: "dai.DeviceInfo") -> "dai.Device":
    try:
        device = dai.Device(info)
    except RuntimeError as error:
        raise opening_error(info, error) from error
    # Capture opens a lost device again by itself, and says so.
    device.setMaxReconnectionAttempts(0)
    return device


def _build(device: "dai.Device", options: OakOptions) -> Connection:
    pipeline = dai.Pipeline(device)
    rate = options.frame_rate
    camera = pipeline.create(dai.node.Camera)
    camera.build(dai.CameraBoardSocket.CAM_A, sensorFps=rate)
    set_controls(camera.initialControl, options)
    kind = dai.ImgFrame.Type.NV12 if options.mjpeg else dai.ImgFrame.Type.RGB888i
    picture = camera.requestOutput(options.pixels, kind, fps=rate, enableUndistortion=True)
    depth = pipeline.create(dai.node.Depth).build(dai.node.Depth.Algorithm.AUTO, fps=rate)
    depth.setAlignTo(picture)
    set_infrared(device, options)
    controls = camera.inputControl.createInputQueue()
    return Connection(
        pipeline=pipeline,
        colour=_compressed(pipeline, picture, rate) if options.mjpeg else picture,
        depth=depth.depth,
        description=_description(device),
        clock_ns=(OAK.network_clock_ns if device.getProtocol() in NETWORK else OAK.usb_clock_ns),
        control=partial(_control, device, controls),
        troubles=lambda: _troubles(device, options),
        died=lambda: _died(device),
        close=device.close,
    )


def _compressed(
    pipeline: "dai.Pipeline", picture: "dai.Node.Output", rate: float
) -> "dai.Node.Output":
    encoder = pipeline.create(dai.node.VideoEncoder).build(
        picture,
        frameRate=rate,
        profile=dai.VideoEncoderProperties.Profile.MJPEG,
        quality=OAK.jpeg_quality,
    )
    return encoder.out


def _description(device: "dai.Device") -> str:
    bootloader = device.getBootloaderVersion()
    parts = [
        f"{device.getProductName() or device.getDeviceName() or 'OAK'} {device.getDeviceId()}",
        device.getPlatformAsString(),
        f"depthai {dai.__version__}",
    ]
    if bootloader is not None:
        parts.append(f"bootloader {bootloader.toString()}")
    return ", ".join(parts)


def _control(
    device: "dai.Device",
    controls: "dai.InputQueue",
    options: OakOptions,
    automatic: Collection[str],
) -> None:
    control = dai.CameraControl()
    set_controls(control, options)
    set_automatic(control, automatic)
    try:
        controls.send(control)
        set_infrared(device, options)
    except RuntimeError as error:
        raise SourceError(f"the camera does not take it: {error}") from error


def _troubles(device: "dai.Device", options: OakOptions) -> dict[str, str]:
    found = {
        "link": link_trouble(device.getUsbSpeed(), options),
        "heat": heat_trouble(device.getChipTemperature().average),
    }
    return {name: text for name, text in found.items() if text is not None}


def _died(device: "dai.Device") -> str | None:
    with contextlib.suppress(RuntimeError):  # a device that is gone cannot say whether it crashed
        if device.hasCrashed():
            return "the camera's firmware crashed"
    return "the camera is gone: cable, power or network" if device.isClosed() else None
