"""What pages do with the controls of viser."""

from typing import Any


def put(control: Any, value: Any) -> None:
    """Give a control of viser, also a progress bar, a value.

    What is done when a person changes it is not done. (mypy takes viser's property for read-only.)
    """
    control.value = value
