"""Exposure, focus, white balance and infrared light of an OAK camera."""

from inhand_runtime.source import SourceError

from inhand_capture.sources.oak.library import dai
from inhand_capture.sources.oak.options import OakOptions


def set_controls(control: "dai.CameraControl", options: OakOptions) -> None:
    """Fix what the settings fix; all else stays automatic."""
    if options.exposure_us is not None and options.iso is not None:
        control.setManualExposure(options.exposure_us, options.iso)
    if options.focus is not None:
        control.setManualFocus(options.focus)
    if options.white_balance_k is not None:
        control.setManualWhiteBalance(options.white_balance_k)


def set_infrared(device: "dai.Device", options: OakOptions) -> None:
    """Light the scene; raises SourceError for a camera without such a lamp."""
    for setting, power, switch in (
        ("ir_dots", options.ir_dots, device.setIrLaserDotProjectorIntensity),
        ("ir_flood", options.ir_flood, device.setIrFloodLightIntensity),
    ):
        if power > 0.0 and not switch(power):
            raise SourceError(f"this camera has no lamp for options.{setting}: leave it out")
