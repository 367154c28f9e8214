"""No message of a daemon that hides faces holds a pixel of a drawn person's head."""

from collections.abc import Mapping

import numpy as np
import pytest
import simplejpeg
from drawn_heads import head_pixels
from fetched_weights import use_weights
from inhand_lab.world.simulation import Simulation, simulate
from inhand_runtime.inbox import Received
from inhand_runtime.pixels import decode_colour, decode_depth
from inhand_schemas.messages import ObjectPose, Preview, RgbdFrame, Skeletons
from inhand_schemas.topics import LABEL, PREVIEW, RGBD, SKELETONS, AnyTopic
from numpy.typing import NDArray
from running_rig import RunningRig
from wire import Wire

pytestmark = pytest.mark.long
FRAMES = 60
BLACK = 70
"""Brightest that JPEG makes a black pixel whose neighbours are not."""


@pytest.mark.parametrize("skeletons", ["estimated", "source"])
def test_no_message_holds_a_pixel_of_a_face_and_skeletons_flow(
    wire: Wire, rig: RunningRig, monkeypatch: pytest.MonkeyPatch, skeletons: str
) -> None:
    use_weights(monkeypatch, "full", "faces")
    topics: tuple[AnyTopic, ...] = (RGBD, PREVIEW, SKELETONS, LABEL)
    heard = {topic.stream: wire.hear(topic) for topic in topics}
    rig.configure(
        f'[capture.front]\nsource = "simulator"\nmask_faces = true\nskeletons = "{skeletons}"\n'
        f"[capture.front.options]\nloop = false\nframes = {FRAMES}\n"
    )
    assert rig.python("-m", "inhand_capture", "--config", rig.config).wait() == 0
    simulation = simulate("drinkFromMug", 0, seed=0, frames=FRAMES)
    heads = [head_pixels(simulation, frame) for frame in range(FRAMES)]
    frames = [RGBD.decode(one.payload) for one in heard[RGBD.stream]]
    assert [frame.sequence for frame in frames] == list(range(FRAMES))
    for frame in frames:
        _has_no(heads[frame.sequence], frame)
    previews = [PREVIEW.decode(one.payload) for one in heard[PREVIEW.stream]]
    assert len(previews) >= 3
    for preview in previews:
        _is_small_and_has_no(heads[preview.sequence], preview)
    _are_near_the_truth(heard)


def _has_no(head: NDArray[np.bool_], frame: RgbdFrame) -> None:
    assert frame.colour is not None
    assert frame.depth is not None
    colour, depth = decode_colour(frame.colour), decode_depth(frame.depth)
    assert not depth[head].any()
    assert colour[head].max() < BLACK
    assert (colour.max(axis=2) > BLACK).mean() > 0.3
    assert (depth > 0).mean() > 0.5


def _is_small_and_has_no(head: NDArray[np.bool_], preview: Preview) -> None:
    picture = simplejpeg.decode_jpeg(preview.jpeg, "RGB")
    assert picture.shape == (preview.height, preview.width, 3) == (240, 320, 3)
    inside = head.reshape(240, 2, 320, 2).all(axis=(1, 3))
    assert picture[inside].max() < BLACK


def _are_near_the_truth(heard: Mapping[str, list[Received]]) -> None:
    labels = [LABEL.decode(one.payload) for one in heard[LABEL.stream]]
    truth = {one.sequence: one for one in labels if isinstance(one, ObjectPose)}
    received = [SKELETONS.decode(one.payload) for one in heard[SKELETONS.stream]]
    assert len(received) >= 10
    for one in received:
        assert isinstance(one, Skeletons)
        (person,) = one.people
        joints = truth[one.sequence].person_joints
        assert joints is not None
        off = np.linalg.norm(np.array(person.joints) - joints, axis=1)
        assert np.median(off) < 0.06


def test_a_simulation_is_the_same_again() -> None:
    def head(simulation: Simulation) -> NDArray[np.bool_]:
        return head_pixels(simulation, 5)

    first, second = (simulate("drinkFromMug", 0, seed=0, frames=FRAMES) for _ in range(2))
    np.testing.assert_array_equal(head(first), head(second))
    assert head(first).sum() > 500
