"""Object poses from body poses and images.

A model, which ``inhand train`` writes, is followed by a tracker; the tracker takes the joints
(20, 3) of one person, in metres in the camera frame, and gives an estimate a frame:

>>> from inhand_tracker import Image, load_model, new_tracker
>>> tracker = new_tracker(load_model(path))
>>> estimate = tracker.step(joints, time_ns, Image(None, camera, depth, colour))
>>> estimate.state, estimate.translation.shape, estimate.rotation.shape
('tracked', (3,), (4,))

Without an image, ``tracker.step(joints, time_ns)`` estimates from the body alone. Everything here
works on arrays; Zenoh is ``service``'s business.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from inhand_tracker.geometry.estimate import Estimate
    from inhand_tracker.geometry.image import Image
    from inhand_tracker.methods.registry import new_tracker
    from inhand_tracker.model.model_file import load_model

__all__ = ["Estimate", "Image", "load_model", "new_tracker"]

_MODULES = {
    "Estimate": "inhand_tracker.geometry.estimate",
    "Image": "inhand_tracker.geometry.image",
    "load_model": "inhand_tracker.model.model_file",
    "new_tracker": "inhand_tracker.methods.registry",
}


def __getattr__(name: str) -> Any:
    """Import an exported name when it is asked for: ``import inhand_tracker.x`` stays light."""
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_MODULES[name]), name)
