"""Processes that find each other, and readers that do not disturb each other."""

import os
import signal
import socket
import time
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from inhand_runtime.errors import InhandError, SettingsError
from inhand_runtime.inbox import Inbox, Received
from inhand_runtime.session import open_session, subscribe
from inhand_runtime.settings import ZenohSettings
from inhand_schemas.messages import (
    CameraInfo,
    ColourImage,
    Event,
    ObjectPose,
    RgbdFrame,
    Skeletons,
)
from inhand_schemas.topics import EVENT, INFO, POSE, RGBD, SKELETONS, AnyTopic
from msgspec.structs import replace
from running_rig import Process, RunningRig, eventually
from wire import Wire, lingering_s

PEER = Path(__file__).with_name("peer.py")
OPENS_WITHIN_S = 5.0

INFO_MESSAGE = CameraInfo(
    sequence=0, time_ns=1, width=64, height=48, fx=50.0, fy=50.0, cx=32.0, cy=24.0
)

LOST = ObjectPose(sequence=0, time_ns=1, object="mug", camera="front", state="lost", confidence=0.0)


def test_peers_that_start_together_find_each_other(rig: RunningRig) -> None:
    for peer in [rig.python(PEER, rig.meeting) for _ in range(3)]:
        peer.said("knows 2")


def three_peers(rig: RunningRig) -> tuple[Process, list[Process]]:
    """The peer that has the meeting address, and two others, when all know each other."""
    first = rig.python(PEER, rig.meeting)
    first.said("knows 0")
    others = [rig.python(PEER, rig.meeting) for _ in range(2)]
    for peer in (first, *others):
        peer.said("knows 2")
    return first, others


def test_peers_find_a_new_one_after_the_first_was_killed(rig: RunningRig) -> None:
    first, others = three_peers(rig)
    first.stop(signal.SIGKILL)
    for peer in others:
        peer.said("knows 2\nknows 1")
    rig.python(PEER, rig.meeting).said("knows 2")
    for peer in others:
        peer.said("knows 2\nknows 1\nknows 2")


def test_two_peers_whose_link_breaks_find_each_other_again(rig: RunningRig) -> None:
    first, others = three_peers(rig)
    others[0].popen.send_signal(signal.SIGUSR1)
    for peer in others:
        peer.said("knows 2\nknows 1\nknows 2")
    assert first.stdout.endswith("knows 2\n")


def test_a_foreign_program_at_the_meeting_address_delays_nobody_for_long() -> None:
    with socket.create_server(("127.0.0.1", 0)) as foreign:
        begin = time.monotonic()
        with open_session(ZenohSettings(meeting=_address(foreign))):
            pass
        assert time.monotonic() - begin < OPENS_WITHIN_S


def test_a_listen_port_in_use_is_refused_with_the_mend(rig: RunningRig) -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:
        settings = ZenohSettings(meeting=rig.meeting, listen=(_address(other),))
        with (
            pytest.raises(SettingsError, match=r"cannot listen on .*in use.*change zenoh\.listen"),
            open_session(settings),
        ):
            pass


def test_a_client_without_a_hub_is_told_so(rig: RunningRig) -> None:
    settings = ZenohSettings(mode="client", connect=(rig.meeting,))
    with (
        pytest.raises(InhandError, match=f"no hub answers at {rig.meeting}"),
        open_session(settings),
    ):
        pass


def test_a_client_that_names_no_hub_is_refused() -> None:
    with (
        pytest.raises(SettingsError, match=r"needs zenoh\.connect"),
        open_session(ZenohSettings(mode="client")),
    ):
        pass


def test_a_kept_topic_reaches_those_who_come_late(wire: Wire, rig: RunningRig) -> None:
    publisher = wire.publisher(INFO, "front")
    publisher.put(INFO_MESSAGE)
    with Wire.at(rig.meeting) as late:
        heard = late.hear(INFO)
        eventually("the kept message", lambda: heard)
        assert [INFO.decode(each.payload, each.encoding) for each in heard] == [INFO_MESSAGE]


def test_a_kept_topic_reaches_those_who_came_before(wire: Wire, rig: RunningRig) -> None:
    heard = wire.hear(INFO)
    with Wire.at(rig.meeting) as late:
        publisher = late.publisher(INFO, "front")
        publisher.put(INFO_MESSAGE)
        eventually("the message", lambda: heard)


def test_a_kept_value_that_is_repeated_comes_once_and_a_new_one_again(
    wire: Wire, rig: RunningRig
) -> None:
    with Wire.at(rig.meeting) as other:
        heard = other.hear(INFO)
        publisher = wire.publisher(INFO, "front")
        publisher.put(INFO_MESSAGE)

        def came() -> bool:
            publisher.repeat()
            return bool(heard)

        eventually("the value", came)
        for _ in range(5):
            publisher.repeat()
        publisher.put(replace(INFO_MESSAGE, sequence=1))
        eventually("the new value", lambda: len(heard) == 2)
        assert [INFO.decode(one.payload).sequence for one in heard] == [0, 1]


def test_a_key_that_somebody_deletes_is_no_message(wire: Wire, rig: RunningRig) -> None:
    with Wire.at(rig.meeting) as other:
        heard = other.hear(SKELETONS)
        publisher = wire.publisher(SKELETONS, "front")
        eventually("the reader", publisher.wanted)
        wire.session.delete(publisher.key)
        publisher.put(Skeletons(sequence=7, time_ns=1))
        eventually("the message", lambda: heard)
        assert [SKELETONS.decode(one.payload).sequence for one in heard] == [7]


def test_links_are_closed_without_waiting_for_what_their_other_end_has_not_taken(
    wire: Wire, rig: RunningRig
) -> None:
    with Wire.at(rig.meeting) as other:
        eventually("the other session", lambda: other.knows(1))
        assert len(lingering_s()) >= 2
        eventually("all close at once", lambda: not any(lingering_s()))


READER = """
import sys, time
from inhand_runtime.session import open_session, subscribe
from inhand_runtime.settings import ZenohSettings
from inhand_schemas.keys import Site
from inhand_schemas.topics import TOPICS
with open_session(ZenohSettings(meeting=sys.argv[1])) as session:
    keep = [
        subscribe(session, topic.pattern(Site()), topic.delivery, lambda sample: None)
        for topic in TOPICS.values()
    ]
    print("reads", flush=True)
    time.sleep(600)
"""


@pytest.mark.long
@pytest.mark.parametrize(
    ("topic", "messages"),
    # With frames until the link of the stopped reader has been closed.
    [(EVENT, 420), (SKELETONS, 420), (RGBD, 840)],
)
def test_a_reader_that_is_stopped_holds_nobody_up(
    topic: AnyTopic, messages: int, wire: Wire, rig: RunningRig
) -> None:
    stopped = rig.python("-c", READER, rig.meeting)
    stopped.said("reads")
    with Wire.at(rig.meeting) as reader:
        heard = reader.hear(topic)
        publisher = wire.publisher(topic, "front")

        def both_read() -> bool:
            publisher.put(_message(topic, 0))
            return bool(heard) and wire.knows(2)

        eventually("both readers", both_read)
        stopped.popen.send_signal(signal.SIGSTOP)
        begin = time.monotonic()
        for number in range(1, messages + 1):
            publisher.put(_message(topic, number))
            time.sleep(max(0.0, begin + number / 60.0 - time.monotonic()))
        took = time.monotonic() - begin
        most_left_out = FRAMES_LEFT_OUT if topic is RGBD else 0

        def goes_on() -> bool:
            numbers = {topic.decode(one.payload).sequence for one in heard}
            steps = sorted({0, *numbers, messages + 1})
            return max(after - one - 1 for one, after in pairwise(steps)) <= most_left_out

        eventually("all messages", goes_on)
    stopped.popen.send_signal(signal.SIGCONT)
    assert took < messages / 60.0 + 2.0  # a reader once held them for 5 s


FRAMES_LEFT_OUT = 60
"""Frames in a row, a second of them, that a busy machine may drop before a reader that runs."""


def _message(topic: AnyTopic, number: int) -> Any:
    stamp = {"sequence": number, "time_ns": number}
    if topic is RGBD:
        return RgbdFrame(**stamp, colour=ColourImage("jpeg", 640, 480, bytes(60_000)))
    if topic is EVENT:
        return Event(**stamp, kind="drop", description="x" * 4000)
    if topic is SKELETONS:
        return Skeletons(**stamp)
    return replace(LOST, **stamp, person_joints=((0.1, 0.2, 0.3),) * 20)


def test_a_publisher_knows_whether_anybody_listens(wire: Wire, rig: RunningRig) -> None:
    publisher = wire.publisher(SKELETONS, "front")
    assert not publisher.wanted()
    with Wire.at(rig.meeting) as reader:
        reader.hear(SKELETONS)
        eventually("a reader", publisher.wanted)
    eventually("no reader", lambda: not publisher.wanted())


def test_the_last_message_before_a_session_closes_arrives(wire: Wire, rig: RunningRig) -> None:
    heard = wire.hear(SKELETONS)
    with Wire.at(rig.meeting) as speaker:
        publisher = speaker.publisher(SKELETONS, "front")
        eventually("the reader", publisher.wanted)
        for number in range(100):
            publisher.put(Skeletons(sequence=number, time_ns=number))
    eventually("the last message", lambda: len(heard) == 100)


def test_a_burst_of_small_messages_arrives_whole_on_a_busy_machine(
    wire: Wire, rig: RunningRig
) -> None:
    heard = wire.hear(POSE)
    for _ in range(4 * (os.cpu_count() or 1)):
        rig.python("-c", "while True: pass")
    with Wire.at(rig.meeting) as speaker:
        publisher = speaker.publisher(POSE, "mug")
        eventually("the reader", publisher.wanted)
        for number in range(300):
            publisher.put(replace(LOST, sequence=number))
    eventually("the last message", lambda: len(heard) == 300)


def test_a_slow_reader_keeps_the_newest_and_slows_nobody(wire: Wire, rig: RunningRig) -> None:
    frames, room = 40, 4
    inbox = Inbox()
    dropped: list[str] = []
    lane = inbox.lane(samples=room, on_drop=dropped.append)
    publisher = wire.publisher(RGBD, "front")
    image = ColourImage("jpeg", 640, 480, os.urandom(300_000))
    first = RgbdFrame(sequence=0, time_ns=0, colour=image)
    with Wire.at(rig.meeting) as fast, Wire.at(rig.meeting) as slow:
        fast_heard, slow_heard = fast.hear(RGBD), slow.hear(RGBD)

        def both_hear() -> bool:
            publisher.put(first)
            return bool(fast_heard and slow_heard)

        eventually("both readers", both_hear)
        keep = subscribe(slow.session, RGBD.pattern(slow.site), RGBD.delivery, lane.put)
        for number in range(1, frames + 1):
            publisher.put(RgbdFrame(sequence=number, time_ns=number, colour=image))
            eventually("the frame", lambda number=number: number in _sequences(fast_heard))
        eventually("the last frame", lambda: frames in _sequences(slow_heard))
        eventually("the full lane", lambda: len(dropped) >= frames - room)
        kept = [sample for _ in range(room) if (sample := inbox.get(0))]
        assert _sequences(kept) == [frames - 3, frames - 2, frames - 1, frames]
        assert inbox.get(0) is None
        keep.undeclare()


def _sequences(samples: list[Received]) -> list[int]:
    return [RGBD.decode(sample.payload, sample.encoding).sequence for sample in samples]


def _address(server: socket.socket) -> str:
    return f"tcp/127.0.0.1:{server.getsockname()[1]}"
