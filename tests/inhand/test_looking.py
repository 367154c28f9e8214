"""What a look at a running site takes, and what it says of what it cannot read."""

import argparse

import msgpack
import pytest
from inhand_runtime.inbox import Received
from inhand_schemas.keys import Site
from inhand_schemas.topics import POSE, RGBD

from inhand.__main__ import main
from inhand.echo import _shown
from inhand.looking import positive_count, positive_number, unreadable
from inhand.rate import Meter

KEY = POSE.key(Site(), "mug")


@pytest.mark.parametrize("text", ["-1", "0", "nan", "inf", "soon"])
def test_a_number_that_is_not_above_zero_is_refused_in_words(text: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError, match=f"write a number above 0, not '{text}'"):
        positive_number(text)


@pytest.mark.parametrize("text", ["-1", "0", "1.5", "many"])
def test_a_count_that_is_none_is_refused_in_words(text: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError, match="write a whole number, 1 or more, not"):
        positive_count(text)
    assert positive_count("3") == 3


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["rate", "--seconds", "-1"], "argument --seconds: write a number above 0, not '-1'"),
        (["echo", "--count", "0"], "argument --count: write a whole number, 1 or more, not '0'"),
        (["replay", "a", "--rate", "-1"], "argument --rate: write a number, 0 or more, not '-1'"),
    ],
)
def test_no_name_of_the_code_is_in_what_the_command_line_says(
    arguments: list[str], words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as end:
        main(arguments)
    assert end.value.code == 2
    assert words in capsys.readouterr().err


@pytest.mark.parametrize("verb", ["echo", "rate"])
@pytest.mark.parametrize("topic", ["pose/spoon/x", "pose/Mug", "pose//", "pose/*"])
def test_a_topic_that_cannot_be_is_one_line(
    verb: str, topic: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([verb, topic, "--seconds", "0.1"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"inhand {verb}: '{topic}' is no STREAM/NAME: name ")


def test_only_another_version_of_ours_is_to_be_updated() -> None:
    assert unreadable(Received(KEY, b"", POSE.encoding, 0)) is None
    newer = unreadable(Received(KEY, b"", "application/msgpack;ObjectPose.v2", 0))
    assert newer is not None
    assert newer.endswith("update the older side")
    foreign = unreadable(Received(KEY, b"", "zenoh/bytes", 0))
    assert foreign is not None
    assert foreign.endswith("a program that is not Inhand's publishes there")


@pytest.mark.parametrize(
    ("message", "words"),
    [
        (msgpack.packb({b"a": 1}), "a name in it is no text"),
        (msgpack.packb([msgpack.ExtType(5, b"x")]), "it holds a ExtType"),
        (b"\x91" * 400 + b"\x01", "nested too deep"),
    ],
)
def test_what_no_message_of_ours_holds_is_not_echoed(message: bytes, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        _shown(msgpack.unpackb(message))


def test_what_is_nested_without_end_is_not_measured() -> None:
    meter = Meter()
    deep = b"\x81\xa1x" + b"\x91" * 100_000 + b"\x01"
    meter.add(Received("home/@v1/kitchen/rgbd/front", deep, RGBD.encoding, 1))
    assert meter.rates() == {}
