"""The settings of an OAK camera."""

import re
from typing import Annotated, Literal, Self

from inhand_runtime.settings import Section
from pydantic import AfterValidator, Field, model_validator

SIZES = {"640x480": (640, 480), "1280x720": (1280, 720)}

_IP = re.compile(r"\d{1,3}(\.\d{1,3}){3}")
_USB_PORT = re.compile(r"\d+(\.\d+)*")


def _ip(text: str) -> str:
    if not _IP.fullmatch(text) or any(int(part) > 255 for part in text.split(".")):
        raise ValueError(f"{text!r} is no IP address: write it as 192.168.1.44")
    return text


def _usb_port(text: str) -> str:
    if not _USB_PORT.fullmatch(text):
        raise ValueError(f"{text!r} is no USB port: write it as `inhand capture --list` does, 1.2")
    return text


class OakOptions(Section):
    """``[capture.NAME.options]`` of an OAK camera.

    At the most one of ``serial``, ``ip`` and ``usb_port`` says which camera; without any there must
    be a single one. ``mjpeg`` lets the device compress colour. ``exposure_us`` and ``iso``, which
    come together, ``focus`` (0 far to 255 near) and ``white_balance_k`` fix what is automatic
    without them. ``ir_dots`` and ``ir_flood`` are shares of the full power.
    """

    serial: str | None = None
    ip: Annotated[str, AfterValidator(_ip)] | None = None
    usb_port: Annotated[str, AfterValidator(_usb_port)] | None = None
    size: Literal["640x480", "1280x720"] = "640x480"
    frame_rate: Annotated[float, Field(ge=1, le=60)] = 30.0
    mjpeg: bool = True
    exposure_us: Annotated[int, Field(ge=1, le=33_000)] | None = None
    iso: Annotated[int, Field(ge=100, le=1600)] | None = None
    focus: Annotated[int, Field(ge=0, le=255)] | None = None
    white_balance_k: Annotated[int, Field(ge=1000, le=12_000)] | None = None
    ir_dots: Annotated[float, Field(ge=0, le=1)] = 0.0
    ir_flood: Annotated[float, Field(ge=0, le=1)] = 0.0

    @model_validator(mode="after")
    def _agree(self) -> Self:
        chosen = [name for name in ("serial", "ip", "usb_port") if getattr(self, name) is not None]
        if len(chosen) > 1:
            raise ValueError(f"{' and '.join(chosen)} both say which camera: keep one of them")
        if (self.exposure_us is None) != (self.iso is None):
            raise ValueError("exposure_us and iso are set together, or both left to the camera")
        return self

    @property
    def pixels(self) -> tuple[int, int]:
        """Width and height of both images."""
        return SIZES[self.size]
