"""What pages do with the controls of viser."""

from typing import Any

import viser


def put(control: viser.GuiInputHandle[Any], value: Any) -> None:
    """Give a control a value; what is done when a person changes it is not done."""
    control.value = value  # type: ignore[misc]  # mypy takes viser's property for read-only
