"""The predictions and hypotheses behind a camera's poses, while somebody wants to see them."""

import threading
from collections.abc import Iterator, Sequence

import numpy as np
import viser
from inhand_runtime.errors import InhandError
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import Pose
from inhand_schemas.procedures import HypothesesReply, ObjectHypotheses
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array, Bytes, Singles
from inhand_tracker.shape.shape import ObjectShape

from inhand_studio.live_page.parameters import LiveParameters
from inhand_studio.live_page.texts import named
from inhand_studio.rig import Rig
from inhand_studio.shapes import Shapes

LIKELIEST, UNLIKELY = np.array([255.0, 110.0, 0.0]), np.array([15.0, 20.0, 60.0])
"""Colours of the likeliest hypothesis, and of those that weigh next to nothing, as the browser gets
them, which shows them lighter (findings/viser-line-colours.sh)."""
WITHOUT_SHAPE_M = 0.1
"""Length in metres of the stick that stands for an object without a mesh."""
AXES_M = 0.05
"""Length in metres of the axes of a prediction."""


class LiveHypotheses:
    """Draws each hypothesis as a stick along the object's longest side, and each prediction as
    axes; how far predictions are from each other is said.

    Trackers are asked by a thread of its own: an answer takes as long as a frame.
    """

    def __init__(
        self, scene: viser.SceneApi, rig: Rig, shapes: Shapes, parameters: LiveParameters
    ) -> None:
        self._scene, self._rig, self._shapes = scene, rig, shapes
        self._parameters = parameters
        self._stop: threading.Event | None = None
        self._replies: list[HypothesesReply] = []
        self._problem: str | None = None
        self._drawn: dict[str, viser.SceneNodeHandle] = {}
        self._drawn_of: list[HypothesesReply] = []

    def want(self, wanted: bool) -> None:
        """Ask the rig's trackers from now on, or no longer."""
        if wanted and self._stop is None:
            self._stop = threading.Event()
            asking = threading.Thread(
                target=self._ask, args=(self._stop,), name="hypotheses", daemon=True
            )
            asking.start()
        elif not wanted and self._stop is not None:
            self._stop.set()
            self._stop = None
            self._replies, self._problem = [], None

    def draw(self, camera: str) -> list[str]:
        """Draw what trackers of a camera said last; returns what is to be said of it."""
        replies = self._replies
        told = [one for reply in replies if reply.camera == camera for one in reply.objects]
        if replies is not self._drawn_of:
            self._drawn_of = replies
            before = self._drawn
            self._drawn = {node.name: node for one in told for node in self._nodes(one)}
            for name in before.keys() - self._drawn.keys():
                before[name].remove()
        if self._stop is None:
            return []
        if self._problem is not None:
            return [self._problem]
        return [line for one in told for line in said_of(one)] or [
            f"No tracker of {camera} has told hypotheses yet: it tells them of people in view."
        ]

    def _ask(self, stop: threading.Event) -> None:
        while not stop.is_set():
            try:
                replies, problem = self._rig.hypotheses(), None
            except (InhandError, MessageError) as error:
                replies, problem = [], f"Hypotheses cannot be shown: {error}."
            if not stop.is_set():
                self._replies, self._problem = replies, problem
            stop.wait(self._parameters.hypotheses_period_s)

    def _nodes(self, one: ObjectHypotheses) -> Iterator[viser.SceneNodeHandle]:
        """Draw what was considered of one object of one person."""
        name = f"/considered/{one.object}_{one.person}"
        if one.poses:
            shape, _ = self._shapes.find(one.object)
            yield self._scene.add_line_segments(
                f"{name}/hypotheses",
                sticks(one.poses, shape),
                stick_colours(np.array(one.weights)),
                thickness=2.0,
                thickness_units="screen",
            )
        if one.predictions:
            translations, turns = _arrays(tuple(one.predictions.values()))
            yield self._scene.add_batched_axes(
                f"{name}/predictions",
                turns,
                translations,
                axes_length=AXES_M,
                axes_radius=0.04 * AXES_M,
            )


def sticks(poses: Sequence[Pose], shape: ObjectShape | None) -> Singles:
    """Return the ends (P, 2, 3), in the camera frame, of the middle line of an object's longest
    side at each pose; of one without a shape, of a short line along z from its origin."""
    ends = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, WITHOUT_SHAPE_M]])
    if shape is not None:
        low, high = shape.vertices.min(axis=0), shape.vertices.max(axis=0)
        longest = int(np.argmax(high - low))
        ends = np.tile(0.5 * (low + high), (2, 1))
        ends[:, longest] = low[longest], high[longest]
    translations, turns = _arrays(poses)
    placed = rotations.rotate(turns[:, None], ends) + translations[:, None]
    return placed.astype(np.float32)


def stick_colours(weights: Array) -> Bytes:
    """Return colours (P, 2, 3), RGB, by weights (P,): the brighter the more a hypothesis weighs,
    beside the likeliest."""
    shares = np.sqrt(weights / max(float(weights.max()), np.finfo(float).tiny))
    mixed = UNLIKELY + shares[:, None] * (LIKELIEST - UNLIKELY)
    return np.repeat(mixed[:, None], 2, axis=1).astype(np.uint8)


def _arrays(poses: Sequence[Pose]) -> tuple[Array, Array]:
    """Poses as translations (P, 3) and rotations (P, 4)."""
    return np.array([one.translation for one in poses]), np.array([one.rotation for one in poses])


def said_of(one: ObjectHypotheses) -> Iterator[str]:
    """Say how many hypotheses of an object are drawn, and where the body's parts take it to be."""
    looked = f"{len(one.poses)} hypotheses" if one.poses else "no hypotheses, for lack of an image"
    yield f"{named(one)}: {looked}, {len(one.predictions)} predictions."
    if one.predictions:
        places = np.array([pose.translation for pose in one.predictions.values()])
        off = np.linalg.norm(places - np.median(places, axis=0), axis=1)
        said = ", ".join(
            f"{part} {100.0 * far:.1f}" for part, far in zip(one.predictions, off, strict=True)
        )
        yield f"Predictions' distance from their median, cm: {said}."
