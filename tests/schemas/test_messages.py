"""Any valid message survives the wire, and any reader of MessagePack understands it."""

import math
from typing import Any

import msgpack
import msgspec
import pytest
from examples import EXAMPLES, POSE
from hypothesis import given
from hypothesis import strategies as st
from inhand_schemas import topics
from inhand_schemas.errors import MessageError, UnknownVersionError
from inhand_schemas.keys import Site
from inhand_schemas.messages import (
    ColourImage,
    DepthImage,
    Message,
    ObjectPose,
    Pose,
    RgbdFrame,
    Skeletons,
)
from inhand_schemas.topics import RGBD, SKELETONS, TOPICS, AnyTopic, Topic
from message_strategies import MESSAGES

messages = st.sampled_from(sorted(MESSAGES)).flatmap(
    lambda stream: st.tuples(st.just(TOPICS[stream]), MESSAGES[stream])
)
streams = pytest.mark.parametrize("stream", sorted(MESSAGES))


@streams
@given(data=st.data())
def test_a_message_decodes_to_itself(stream: str, data: st.DataObject) -> None:
    topic, message = TOPICS[stream], data.draw(MESSAGES[stream])
    encoded = topic.encode(message)
    assert topic.decode(encoded, topic.encoding) == message
    assert topic.encode(topic.decode(encoded)) == encoded


@streams
@given(data=st.data())
def test_a_look_at_a_message_says_what_it_decodes_to(stream: str, data: st.DataObject) -> None:
    topic, message = TOPICS[stream], data.draw(MESSAGES[stream])
    encoded = topic.encode(message)
    looked = topic.check(encoded, topic.encoding)
    assert isinstance(looked, topic.message_type)
    assert msgspec.msgpack.encode(looked) == encoded


@given(messages)
def test_bare_msgpack_reads_what_a_message_says(drawn: tuple[AnyTopic, Message]) -> None:
    topic, message = drawn
    plain = msgpack.unpackb(topic.encode(message), use_list=False)
    assert plain == msgspec.to_builtins(message, builtin_types=(bytes,))


@given(MESSAGES["rgbd"])
def test_pixels_stay_bytes(message: RgbdFrame) -> None:
    plain = msgpack.unpackb(RGBD.encode(message))
    for image in (plain["colour"], plain["depth"]):
        assert image is None or type(image["data"]) is bytes


@given(messages)
def test_bare_msgpack_writes_what_a_topic_reads(drawn: tuple[AnyTopic, Message]) -> None:
    topic, message = drawn
    plain = msgspec.to_builtins(message, builtin_types=(bytes,))
    assert topic.decode(msgpack.packb(plain)) == message


@given(messages, st.dictionaries(st.text(min_size=20), st.integers(0, 100) | st.text()))
def test_fields_of_the_future_are_passed_over(
    drawn: tuple[AnyTopic, Message], future: dict[str, object]
) -> None:
    topic, message = drawn
    plain = msgspec.to_builtins(message, builtin_types=(bytes,))
    assert topic.decode(msgpack.packb({"later_field": [1, {}], **future, **plain})) == message


def changed(message: Message, **fields: Any) -> bytes:
    plain = msgspec.to_builtins(message, builtin_types=(bytes,))
    return msgpack.packb(plain | fields)


EXAMPLE = {type(message): message for message in EXAMPLES}


def test_a_look_at_a_frame_copies_no_picture() -> None:
    encoded = RGBD.encode(EXAMPLE[RgbdFrame])
    looked = RGBD.check(encoded)
    assert looked.colour is not None
    assert looked.depth is not None
    for picture in (looked.colour.data, looked.depth.data):
        assert isinstance(picture, memoryview)
        assert picture.obj is encoded


@pytest.mark.parametrize(
    "fields",
    [
        {"sequence": -1},
        {"time_ns": 2**63},
        {"time_ns": 1.5},
        {"object": "Mug"},
        {"object": "mug\n"},
        {"object": ""},
        {"object": "m" * 65},
        {"object": b"mug"},
        {"state": "found"},
        {"confidence": 1.001},
        {"confidence": math.nan},
        {"camera_from_object": None},
        {"camera_from_object": {"translation": [0, 0, 0], "rotation": [1, 0.1, 0, 0]}},
        {"camera_from_object": {"translation": [0, 0, math.inf], "rotation": [1, 0, 0, 0]}},
        {"covariance": [0.0] * 35},
        {"covariance": [math.nan] * 36},
        {"box": {"left": 0, "top": 0, "width": -1, "height": 1}},
        {"class_probabilities": {"mug": 2}},
        {"class_probabilities": {"No Name": 0.5}},
        {"visible_fraction": 1.5},
        {"visible_fraction": math.nan},
        {"contact": "foot"},
        {"person_joints": [[0, 0, 1]] * 19},
        {"person_joints": [[0, 0, math.inf]] * 20},
    ],
    ids=str,
)
def test_a_pose_that_cannot_be_is_refused(fields: dict[str, Any]) -> None:
    with pytest.raises(MessageError, match="no valid ObjectPose"):
        topics.POSE.decode(changed(EXAMPLE[ObjectPose], **fields))


def test_a_lost_object_needs_no_pose() -> None:
    fields = {"camera_from_object": None, "state": "lost"}
    assert topics.POSE.decode(changed(EXAMPLE[ObjectPose], **fields)).state == "lost"


@pytest.mark.parametrize(
    "make",
    [
        lambda: ColourImage("rgb8", 4, 2, bytes(23)),
        lambda: DepthImage("z16", 4, 2, bytes(17)),
        lambda: Pose((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0)),
        lambda: Pose((0.0, 0.0, math.nan), (1.0, 0.0, 0.0, 0.0)),
    ],
)
def test_a_value_that_cannot_be_is_refused_when_it_is_made(make: Any) -> None:
    with pytest.raises(ValueError, match=r"do not fill|no unit quaternion|not finite"):
        make()


def test_a_person_has_twenty_joints() -> None:
    plain = msgpack.unpackb(SKELETONS.encode(EXAMPLE[Skeletons]))
    plain["people"][0]["joints"].pop()
    with pytest.raises(MessageError, match="length >= 20"):
        SKELETONS.decode(msgpack.packb(plain))


@pytest.mark.parametrize("nowhere", [(0.0, 0.0, 0.0), (math.nan,) * 3, (1.0, math.inf, 2.0)])
def test_a_joint_without_a_place_is_missing_whatever_its_state_says(
    nowhere: tuple[float, float, float],
) -> None:
    plain = msgpack.unpackb(SKELETONS.encode(EXAMPLE[Skeletons]))
    person = plain["people"][0]
    person["joints"] = [[0.1, 0.2, 2.0 + joint] for joint in range(20)]
    person["states"] = ["tracked"] * 20
    person["joints"][7] = nowhere
    (read,) = SKELETONS.decode(msgpack.packb(plain)).people
    assert read.states == ("tracked",) * 7 + ("missing",) + ("tracked",) * 12
    assert read.joints[7] == (0.0, 0.0, 0.0)
    assert read.joints[8] == (0.1, 0.2, 10.0)


def test_a_joint_of_which_no_confidence_is_known_has_none_and_the_others_keep_theirs() -> None:
    plain = msgpack.unpackb(SKELETONS.encode(EXAMPLE[Skeletons]))
    plain["people"][0]["confidences"] = [0.5] * 19 + [math.nan]
    (read,) = SKELETONS.decode(msgpack.packb(plain)).people
    assert read.confidences == (0.5,) * 19 + (0.0,)


def test_a_topic_encodes_its_own_type_only() -> None:
    with pytest.raises(MessageError, match="skeletons carries Skeletons, not ObjectPose"):
        SKELETONS.encode(EXAMPLE[ObjectPose])


@pytest.mark.parametrize(
    "encoding",
    ["", "application/json", "application/msgpack;ObjectPose.v1", "text/plain;Skeletons.v1"],
)
def test_another_encoding_is_refused(encoding: str) -> None:
    with pytest.raises(MessageError, match=r"skeletons carries application/msgpack;Skeletons.v1"):
        SKELETONS.decode(b"\x80", encoding)


def test_another_version_of_a_type_is_told() -> None:
    with pytest.raises(UnknownVersionError, match="version 2"):
        SKELETONS.decode(b"\x80", "application/msgpack;Skeletons.v2")


def test_an_example_fills_every_field() -> None:
    for message in EXAMPLES:
        plain = msgspec.to_builtins(message, builtin_types=(bytes,))
        assert not [name for name, value in plain.items() if value in (None, {}, (), [])]
    assert POSE in (EXAMPLE[ObjectPose].camera_from_object,)


@pytest.mark.parametrize(
    ("topic", "name"), [(topics.POSE, "mug"), (topics.LABEL, "mug"), (topics.HEALTH, "mug")]
)
def test_a_message_in_another_s_name_than_its_key_s_is_refused(
    topic: Topic[Any], name: str
) -> None:
    message = next(one for one in EXAMPLES if isinstance(one, topic.message_type))
    named = msgspec.structs.replace(message, **{str(topic.named): name})
    site = Site("home", "kitchen")
    assert topic.received(topic.key(site, name), topic.encode(named), topic.encoding) == named
    with pytest.raises(MessageError, match="in the name of 'mug'"):
        topic.received(topic.key(site, "other"), topic.encode(named), topic.encoding)
