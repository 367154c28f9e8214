"""What a Kinect's depth alone does."""

import numpy as np
import pytest
from inhand_lab.sensing.cameras import KINECT
from inhand_lab.sensing.depth_scene import DepthScene, fields_for
from inhand_lab.sensing.noise_fields import FIELD
from inhand_lab.sensing.noise_parameters import DEFAULT_NOISE, StructuredLightNoise
from inhand_lab.sensing.structured_light import (
    measure_structured_light_depth,
    read_still_room,
)
from walls import depth_of, wall


def test_the_kinects_steps_are_eighths_of_a_pixel() -> None:
    steps = [
        np.diff(np.unique(depth_of(wall(distance, KINECT), KINECT))[1:]).max()
        for distance in (1.0, 2.0, 4.0)
    ]
    assert steps == pytest.approx([3.0, 12.0, 46.0], rel=0.2)


def test_the_projector_leaves_a_shadow_to_the_left_of_a_near_thing() -> None:
    canvas = wall(4.0, KINECT)
    canvas.inverse_depth[200:280, 300:340] = 1.0 / 1.5
    depth = depth_of(canvas, KINECT)
    width = 525 * 0.075 * (1 / 1.5 - 1 / 4.0)
    assert (depth[210:270, 303 - int(width) : 298] == 0).mean() > 0.9
    assert (depth[210:270, 345:360] == 0).mean() < 0.05


def test_depth_is_what_the_plain_definition_says() -> None:
    noise = DEFAULT_NOISE.structured_light
    random = np.random.default_rng(3)
    canvas = wall(3.0, KINECT)
    canvas.inverse_depth[100:300, 200:330] = 1.0 / random.uniform(0.3, 9.0, (200, 130))
    canvas.labels[150:200, 250:300] = 3
    scene = DepthScene(
        canvas.colour, canvas.inverse_depth, canvas.labels, 525.0, 3, (1000, 77), (31, 1011)
    )
    depth = measure_structured_light_depth(scene, noise)
    assert (depth == 0).mean() > 0.02
    np.testing.assert_array_equal(depth, _plain(scene, noise))


@pytest.mark.parametrize("drawn", [(100, 300, 200, 330), (0, 480, 0, 640), (0, 9, 630, 640)])
def test_a_frame_before_a_still_room_is_measured_as_one_that_is_read_anew(
    drawn: tuple[int, int, int, int],
) -> None:
    noise = DEFAULT_NOISE.structured_light
    random = np.random.default_rng(4)
    room, canvas = wall(4.0, KINECT), wall(4.0, KINECT)
    room.inverse_depth[50:450, 400:480] = 1.0 / 2.0
    top, bottom, left, right = drawn
    nearer = 1.0 / random.uniform(0.3, 2.0, (bottom - top, right - left))
    canvas.inverse_depth[:] = room.inverse_depth
    canvas.inverse_depth[top:bottom, left:right] = nearer

    def scene(inverse_depth: np.ndarray, unseen: int, fresh: tuple[int, int]) -> DepthScene:
        return DepthScene(
            canvas.colour, inverse_depth, canvas.labels, 525.0, unseen, (1000, 77), fresh
        )

    still = read_still_room(scene(room.inverse_depth, 0, (0, 0)), noise)
    frame = scene(canvas.inverse_depth, 3, (31, 1011))
    np.testing.assert_array_equal(
        measure_structured_light_depth(frame, noise, still, drawn),
        measure_structured_light_depth(frame, noise),
    )


def _plain(scene: DepthScene, noise: StructuredLightNoise) -> np.ndarray:
    fields, inverse_depth = fields_for(noise), scene.inverse_depth
    height, width = inverse_depth.shape
    v, u = np.mgrid[0:height, 0:width]
    lasting = (v + scene.lasting[0]) % FIELD, (u + scene.lasting[1]) % FIELD
    fresh = (v + scene.fresh[0]) % FIELD, (u + scene.fresh[1]) % FIELD
    near_v = np.clip(v + fields.lateral[lasting][..., 0], 0, height - 1)
    near_u = np.clip(u + fields.lateral[lasting][..., 1], 0, width - 1)
    inverse = inverse_depth[near_v, near_u]

    places = u - (np.float32(scene.focal * noise.baseline) * inverse_depth).astype(np.float64)
    lit_from = np.minimum.accumulate(places[:, ::-1], axis=1)[:, ::-1]
    shadowed = places > np.column_stack((lit_from[:, 1:], np.full(height, 1e9))) + noise.shadow
    measured = (inverse >= 1.0 / noise.furthest) & (inverse <= 1.0 / noise.nearest)
    seen = scene.labels[near_v, near_u] != scene.unseen
    beside = inverse_depth[near_v, np.maximum(near_u - 1, 0)]
    above = inverse_depth[np.maximum(near_v - 1, 0), near_u]
    jump = np.maximum(np.abs(beside - inverse), np.abs(above - inverse)).astype(np.float64)
    lost = (jump > noise.edge_jump * inverse.astype(np.float64)) & (
        fields.patches[fresh] < noise.edge_loss
    )
    beyond = np.float32(1.0) / inverse - np.float32(noise.most_exact)
    deviation = np.float32(noise.least_deviation)
    deviation = deviation + np.float32(noise.deviation_growth) * beyond * beyond
    error = np.float32(np.sqrt(1.0 - noise.fresh**2)) * fields.axial[lasting]
    error = error + np.float32(noise.fresh) * fields.axial[fresh]
    steps = np.float32(noise.focal_length * noise.baseline * noise.steps_per_pixel)
    disparity = (steps * inverse) * (1.0 + (deviation * inverse * error).astype(np.float64))
    depth = np.float32(1000.0) * steps / np.rint(disparity)
    return np.where(measured & seen & ~shadowed & ~lost, depth, 0.0).astype(np.uint16)
