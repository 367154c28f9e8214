"""Members who do harm within what they may do, and strangers at the door, at a hub that runs."""

import contextlib
import itertools
import os
import signal
import socket
import threading
import time
from collections.abc import Callable, Iterator

import pytest
import zenoh
from hub_site import SITE, HubSite, message_of
from inhand_runtime.inbox import Received
from inhand_schemas.topics import HEALTH, RGBD, SKELETONS
from msgspec.structs import replace
from running_rig import eventually

pytestmark = pytest.mark.long

MORE_THAN_LINKS_OF_ONE = 33
MORE_THAN_WAIT = 130
LONGEST_PAUSE_S = 3.0
"""What a machine that is busy makes of a message each 20 ms; a hub that stands still takes 10 s."""


def test_a_camera_that_lets_nothing_be_dropped_stops_nobody_where_a_reader_stands_still(
    site: HubSite,
) -> None:
    stopped = site.rig.inhand("rate", "rgbd", "--config", site.config("disk"), "--seconds", "600")
    with site.joined("front") as camera, site.joined("back") as other, site.joined("desk") as desk:
        key, frame = RGBD.key(SITE, "front"), os.urandom(200_000)
        demanding = camera.session.declare_publisher(
            key,
            encoding=RGBD.encoding,
            congestion_control=zenoh.CongestionControl.BLOCK,
            priority=zenoh.Priority.REAL_TIME,
        )
        eventually("its reader", lambda: demanding.matching_status.matching)
        stopped.popen.send_signal(signal.SIGSTOP)
        heard = desk.hear(SKELETONS)
        outlet = other.publisher(SKELETONS, "back")

        def came() -> bool:
            outlet.put(message_of(SKELETONS))
            return len(heard) > 5

        eventually("the other camera", came)
        with _repeated(lambda: demanding.put(frame)):
            end = time.monotonic() + 4.0
            while time.monotonic() < end:
                outlet.put(message_of(SKELETONS))
                time.sleep(0.02)
        arrived = [one.arrived for one in heard] + [time.monotonic()]
        assert max(b - a for a, b in itertools.pairwise(arrived)) < LONGEST_PAUSE_S
    stopped.popen.kill()


def test_what_a_camera_says_in_the_names_of_others_is_told_and_changes_nothing(
    site: HubSite,
) -> None:
    with site.joined("back") as camera:
        key, well = HEALTH.key(SITE, "back"), message_of(HEALTH)
        forged = HEALTH.encode(replace(well, service="hub", instance="hub", troubles=("forged",)))

        def put() -> None:
            camera.session.put(key, forged, encoding=HEALTH.encoding)
            camera.session.put(key, forged, encoding="text/plain;[/b]\x1b[2J")

        with _repeated(put):
            status = site.rig.done("status", "--config", site.config("anna"), "--seconds", "10")
    assert status.popen.returncode == 0, status.stderr
    assert "hub hub" in status.stdout
    assert "forged" not in status.stdout
    remarks = status.stderr.splitlines()
    assert any("a Health in the name of 'hub'" in one for one in remarks)
    assert any("[/b]" in one for one in remarks)
    assert len(remarks) == 2
    assert all(one.isprintable() for one in remarks)


def test_one_who_connects_too_often_and_a_crowd_at_the_door_are_told(site: HubSite) -> None:
    with site.joined("desk") as desk:
        heard = desk.hear(HEALTH)
        with contextlib.ExitStack() as opened:
            for _ in range(MORE_THAN_LINKS_OF_ONE):
                opened.enter_context(site.joined("anna"))
            crowd = f"{site.member('anna').common_name} is connected more than 32 times"
            eventually("the crowd", lambda: crowd in _troubles(heard))
        with contextlib.ExitStack() as knocking:
            host, _, port = site.address.removeprefix("tls/").rpartition(":")
            for _ in range(MORE_THAN_WAIT):
                knocking.enter_context(socket.create_connection((host, int(port))))
            door = "more than 128 connections show no valid certificate"
            eventually("the door", lambda: door in _troubles(heard))
            assert crowd not in _troubles(heard)


def _troubles(healths: list[Received]) -> str:
    """What the hub last called troubles."""
    own = [one for one in healths if one.key == HEALTH.key(SITE, "hub")]
    return "\n".join(trouble for one in own[-1:] for trouble in HEALTH.decode(one.payload).troubles)


@contextlib.contextmanager
def _repeated(action: Callable[[], object]) -> Iterator[None]:
    """Do something each 10 ms, in a thread, until the block ends."""
    ended = threading.Event()

    def repeat() -> None:
        while not ended.wait(0.01):
            action()

    thread = threading.Thread(target=repeat)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()
