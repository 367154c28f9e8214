"""Hypothesis strategies for any valid message of each type."""

import math

from hypothesis import strategies as st
from inhand_schemas.fields import LONGEST_LENS, WIDEST_LENS
from inhand_schemas.messages import (
    Box,
    CameraInfo,
    ColourImage,
    DepthImage,
    Event,
    Health,
    Latency,
    ObjectPose,
    Person,
    Pose,
    Preview,
    RgbdFrame,
    Skeletons,
    TopicHealth,
)

counts = st.integers(0, 2**63 - 1)
pixels = st.integers(1, 4096)
finite = st.floats(allow_nan=False, allow_infinity=False)
positive = st.floats(0, exclude_min=True, allow_infinity=False)
non_negative = st.floats(0, allow_infinity=False)
fractions = st.floats(0, 1)
names = st.text("abcdefghijklmnopqrstuvwxyz0123456789_", min_size=1, max_size=64)
texts = st.text(max_size=100)
vectors = st.tuples(finite, finite, finite)
stamps = {"sequence": counts, "time_ns": counts}


def _unit(numbers: tuple[float, float, float, float]) -> tuple[float, ...]:
    length = math.hypot(*numbers)
    return tuple(number / length for number in numbers)


_component = st.floats(-1, 1)
quaternions = (
    st.tuples(_component, _component, _component, _component)
    .filter(lambda numbers: math.hypot(*numbers) > 0.01)
    .map(_unit)
)
poses = st.builds(Pose, vectors, quaternions)
boxes = st.builds(Box, finite, finite, non_negative, non_negative)

_in_widths = st.floats(WIDEST_LENS, LONGEST_LENS)


@st.composite
def _camera_infos(draw: st.DrawFn) -> CameraInfo:
    width, height = draw(pixels), draw(pixels)
    size = max(width, height)
    far = LONGEST_LENS * size
    return CameraInfo(
        sequence=draw(counts),
        time_ns=draw(counts),
        width=width,
        height=height,
        fx=draw(_in_widths) * size,
        fy=draw(_in_widths) * size,
        cx=draw(st.floats(-far, far)),
        cy=draw(st.floats(-far, far)),
        distortion=tuple(draw(st.lists(finite, max_size=14))),
        depth_scale=draw(st.floats(1e-6, 1.0)),
        frame_rate=draw(st.floats(1e-3, 1e4)),
        rig_from_camera=draw(poses),
        description=draw(texts),
    )


camera_infos = _camera_infos()

small = st.integers(1, 8)
colour_images = st.one_of(
    st.builds(ColourImage, st.just("jpeg"), pixels, pixels, st.binary()),
    st.builds(
        lambda width, height: ColourImage("rgb8", width, height, b"\x7f" * 3 * width * height),
        small,
        small,
    ),
)
depth_images = st.one_of(
    st.builds(DepthImage, st.just("z16-zstd"), pixels, pixels, st.binary()),
    st.builds(
        lambda width, height: DepthImage("z16", width, height, b"\x00\x04" * width * height),
        small,
        small,
    ),
)
rgbd_frames = st.builds(
    RgbdFrame,
    **stamps,
    time_uncertainty_ns=counts,
    colour=st.none() | colour_images,
    depth=st.none() | depth_images,
)
previews = st.builds(Preview, **stamps, width=pixels, height=pixels, jpeg=st.binary())


def _twenty(elements: st.SearchStrategy[object]) -> st.SearchStrategy[tuple[object, ...]]:
    return st.lists(elements, min_size=20, max_size=20).map(tuple)


people = st.builds(
    Person,
    id=counts,
    joints=_twenty(vectors),
    states=_twenty(st.sampled_from(["missing", "inferred", "tracked"])),
    confidences=_twenty(fractions),
)
skeletons = st.builds(
    Skeletons,
    **stamps,
    people=st.lists(people, max_size=3).map(tuple),
    convention=st.none() | names,
)

_estimates = {
    "object": names,
    "camera": names,
    "confidence": fractions,
    "person": st.none() | counts,
    "rig_from_object": st.none() | poses,
    "covariance": st.none() | st.lists(finite, min_size=36, max_size=36).map(tuple),
    "box": st.none() | boxes,
    "class_probabilities": st.dictionaries(names, fractions, max_size=5),
    "visible_fraction": st.none() | fractions,
    "contact": st.sampled_from([None, "resting", "right_hand", "left_hand", "both_hands", "worn"]),
    "person_joints": st.none() | _twenty(vectors),
}
object_poses = st.one_of(
    st.builds(
        ObjectPose,
        **stamps,
        **_estimates,
        state=st.sampled_from(["tracked", "predicted"]),
        camera_from_object=poses,
    ),
    st.builds(
        ObjectPose,
        **stamps,
        **_estimates,
        state=st.just("lost"),
        camera_from_object=st.none() | poses,
    ),
)
events = st.builds(
    Event,
    **stamps,
    kind=names,
    object=st.none() | names,
    person=st.none() | counts,
    duration_ns=counts,
    evidence=st.dictionaries(names, finite, max_size=5),
    description=texts,
)
healths = st.builds(
    Health,
    **stamps,
    service=names,
    instance=names,
    state=st.sampled_from(["starting", "running", "degraded", "stopping"]),
    uptime_s=non_negative,
    resident_bytes=counts,
    topics=st.dictionaries(
        texts,
        st.builds(
            TopicHealth,
            published=counts,
            received=counts,
            dropped=counts,
            malformed=counts,
            rate_hz=non_negative,
            lost=counts,
            late_ms=st.none() | non_negative,
        ),
        max_size=3,
    ),
    latency_ms=st.none() | st.builds(Latency, p50=finite, p99=finite),
    last_error=st.none() | texts,
    troubles=st.lists(texts, max_size=3).map(tuple),
    loop_age_s=non_negative,
    effort=st.none() | fractions,
)

MESSAGES = {
    "info": camera_infos,
    "rgbd": rgbd_frames,
    "preview": previews,
    "skeletons": skeletons,
    "pose": object_poses,
    "event": events,
    "label": object_poses,
    "health": healths,
}
"""A strategy by stream."""
