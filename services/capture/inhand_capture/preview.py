"""Small pictures at a low rate, for people who look."""

import simplejpeg
from inhand_runtime.health import HealthBoard
from inhand_runtime.pixels import raw_colour
from inhand_runtime.source import Captured
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import Preview
from numpy import ascontiguousarray, uint8
from numpy.typing import NDArray

from inhand_capture.parameters import DEFAULT_PREVIEW, PreviewParameters
from inhand_capture.publishing import Outlet

TROUBLE = "preview"


class Previews:
    """Publishes previews of one camera's moments while somebody listens."""

    def __init__(
        self,
        outlet: Outlet[Preview],
        health: HealthBoard,
        parameters: PreviewParameters = DEFAULT_PREVIEW,
    ) -> None:
        self._outlet = outlet
        self._health = health
        self._parameters = parameters
        self._last_ns: int | None = None

    def wanted(self) -> bool:
        """Whether anybody listens to previews now."""
        return self._outlet.wanted()

    def publish(self, captured: Captured, sequence: int) -> None:
        """Send a preview of a moment if one is due, with the number and time of its frame.

        A picture that is damaged is a trouble until one is whole.
        """
        if captured.pixels is None or not self.wanted() or not self._is_due(captured.time_ns):
            return
        try:
            colour = raw_colour(captured.pixels().colour)
        except MessageError as error:
            self._health.trouble(TROUBLE, f"there is no preview of a picture: {error}")
            return
        if colour is not None:
            self._outlet.put(preview_of(colour, sequence, captured.time_ns, self._parameters))
            self._health.well(TROUBLE)

    def _is_due(self, time_ns: int) -> bool:
        """Whether a preview of this moment is due; one of a clock that was set back is."""
        last_ns = self._last_ns
        if last_ns is not None and 0 <= time_ns - last_ns < 1e9 * self._parameters.period_s:
            return False
        self._last_ns = time_ns
        return True


def preview_of(
    colour: NDArray[uint8],
    sequence: int,
    time_ns: int,
    parameters: PreviewParameters = DEFAULT_PREVIEW,
) -> Preview:
    """Make a preview of a frame's colour (H, W, 3) RGB; a small one is not enlarged."""
    import cv2

    scale = min(1.0, parameters.longest_side / max(colour.shape[:2]))
    height, width = (max(1, round(scale * side)) for side in colour.shape[:2])
    small = cv2.resize(colour, (width, height), interpolation=cv2.INTER_AREA)
    jpeg = simplejpeg.encode_jpeg(ascontiguousarray(small, uint8), parameters.quality, "RGB", "420")
    return Preview(sequence=sequence, time_ns=time_ns, width=width, height=height, jpeg=jpeg)
