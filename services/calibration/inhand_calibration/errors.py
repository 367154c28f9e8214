"""The fault of a calibration that cannot be made of what was seen."""

from inhand_runtime.errors import InhandError


class CalibrationError(InhandError):
    """What was seen does not say where cameras are; the message says what to do. Exit code 1."""
