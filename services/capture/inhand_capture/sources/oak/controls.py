"""Exposure, focus, white balance and infrared light of an OAK camera."""

from collections.abc import Collection

from inhand_runtime.source import SourceError

from inhand_capture.sources.oak.library import dai
from inhand_capture.sources.oak.options import OakOptions

CONTROLS = ("exposure_us", "iso", "focus", "white_balance_k", "ir_dots", "ir_flood")
"""Names of the options that can be changed while a camera runs."""


def set_controls(control: "dai.CameraControl", options: OakOptions) -> None:
    """Fix what the settings fix."""
    if options.exposure_us is not None and options.iso is not None:
        control.setManualExposure(options.exposure_us, options.iso)
    if options.focus is not None:
        control.setManualFocus(options.focus)
    if options.white_balance_k is not None:
        control.setManualWhiteBalance(options.white_balance_k)


def set_automatic(control: "dai.CameraControl", names: Collection[str]) -> None:
    """Leave to the camera what was fixed before: options by their names."""
    if "exposure_us" in names:
        control.setAutoExposureEnable()
    if "focus" in names:
        control.setAutoFocusMode(dai.CameraControl.AutoFocusMode.CONTINUOUS_VIDEO)
    if "white_balance_k" in names:
        control.setAutoWhiteBalanceMode(dai.CameraControl.AutoWhiteBalanceMode.AUTO)


def set_infrared(device: "dai.Device", options: OakOptions) -> None:
    """Light the scene; raises SourceError for a camera without such a lamp."""
    for setting, power, switch in (
        ("ir_dots", options.ir_dots, device.setIrLaserDotProjectorIntensity),
        ("ir_flood", options.ir_flood, device.setIrFloodLightIntensity),
    ):
        if not switch(power) and power > 0.0:
            raise SourceError(f"this camera has no lamp for options.{setting}: leave it out")
