"""A closed shutter stops all pictures and skeletons, says so, and stays closed."""

import stat
from pathlib import Path

import pytest
from inhand_capture.shutter import Shutter, ShutteredOutlet, ShutterFile
from inhand_runtime.inbox import Received
from inhand_runtime.questions import ask
from inhand_schemas.keys import Site
from inhand_schemas.messages import Health, Skeletons
from inhand_schemas.procedures import SHUTTER, ShutterReply, ShutterRequest
from inhand_schemas.topics import HEALTH, INFO, RGBD, SKELETONS
from running_rig import Process, RunningRig, eventually
from wire import Wire

pytestmark = pytest.mark.usefixtures("own_data")


class Heard:
    """An outlet that remembers."""

    def __init__(self) -> None:
        self.messages: list[Skeletons] = []

    def put(self, message: Skeletons) -> None:
        self.messages.append(message)

    def wanted(self) -> bool:
        return True


def _shutter(*, closed: bool = False) -> Shutter:
    return Shutter(ShutterFile(Site(), "front"), closed=closed)


def test_nothing_is_wanted_or_sent_while_it_is_closed() -> None:
    heard, shutter = Heard(), _shutter()
    outlet = ShutteredOutlet(heard, shutter)
    for number in range(3):
        assert outlet.wanted() == (number != 1)
        outlet.put(Skeletons(sequence=number, time_ns=1))
        shutter.move(closed=number == 0)
    assert [message.sequence for message in heard.messages] == [0, 2]


def test_it_is_kept_for_each_camera_by_itself() -> None:
    assert _shutter().move(closed=True) is None
    assert ShutterFile(Site(), "front").is_closed()
    assert not ShutterFile(Site(), "back").is_closed()
    assert not ShutterFile(Site(rig="attic"), "front").is_closed()
    assert _shutter(closed=True).move(closed=False) is None
    assert not ShutterFile(Site(), "front").is_closed()


def test_it_closes_and_says_so_where_that_cannot_be_kept(own_data: Path) -> None:
    own_data.write_text("a file where the folder should be")
    shutter = _shutter()
    problem = shutter.move(closed=True)
    assert shutter.is_closed()
    assert problem is not None
    assert "it is closed until the next start only" in problem
    assert "set INHAND_DATA" in problem


def test_its_file_is_nobody_elses_to_change() -> None:
    _shutter().move(closed=True)
    mode = ShutterFile(Site(), "front").path.stat().st_mode
    assert not mode & (stat.S_IWGRP | stat.S_IWOTH)


def _start(rig: RunningRig, plugins: Path) -> Process:
    rig.configure(
        '[capture.front]\nsource = "scripted"\nwait_for_reader_s = 0\n'
        "[capture.front.options]\nscript = [100000]\n"
    )
    arguments = ("-m", "inhand_capture", "--config", rig.config)
    return rig.python(*arguments, PYTHONPATH=str(plugins))


def _told(rig: RunningRig, *arguments: str) -> tuple[int, str]:
    done = rig.done(*arguments, "--config", rig.config)
    return done.popen.returncode, done.stdout


def _health(heard: list[Received]) -> Health | None:
    return HEALTH.decode(heard[-1].payload) if heard else None


@pytest.mark.long
def test_one_command_stops_all_at_once_and_it_stays_so_through_a_restart(
    wire: Wire, rig: RunningRig, plugin_folder: Path
) -> None:
    streams = wire.hear(RGBD), wire.hear(SKELETONS)
    health = wire.hear(HEALTH)
    daemon = _start(rig, plugin_folder)
    for heard in streams:
        eventually("moments", lambda heard=heard: len(heard) > 5)
    assert _told(rig, "shutter", "close") == (0, "front: closed\n")
    eventually("health", lambda: (h := _health(health)) and h.shutter_closed)
    for heard in streams:
        heard.clear()
    code, status = _told(rig, "status")
    assert code == 0, "a shutter that is closed is no fault"
    assert "the shutter is closed: no pictures and no skeletons until" in status
    assert daemon.stop() == 0

    again = _start(rig, plugin_folder)
    again.said("the shutter is closed: nothing is captured")
    eventually("a running state", lambda: (h := _health(health)) and h.state == "running")
    assert streams == ([], []), "nothing came since the reply, and after the restart"
    assert _told(rig, "shutter", "open", "--camera", "front") == (0, "front: open\n")
    for heard in streams:
        eventually("moments", lambda heard=heard: len(heard) > 5)
    eventually("an open shutter", lambda: (h := _health(health)) and h.shutter_closed is False)
    assert again.stop() == 0


@pytest.mark.long
def test_a_source_that_was_shut_goes_on_and_its_sequence_too(
    wire: Wire, rig: RunningRig, plugin_folder: Path
) -> None:
    heard, infos = wire.hear(SKELETONS), wire.hear(INFO)
    daemon = _start(rig, plugin_folder)
    for _ in range(2):
        before = len(heard)
        eventually("moments", lambda before=before: len(heard) > before + 5)
        assert _told(rig, "shutter", "close")[0] == 0
        # As programs of before ask, which know no key of a camera's own.
        request = SHUTTER.encode(ShutterRequest(closed=False))
        ((_, reply),) = ask(wire.session, SHUTTER.shared_key(wire.site), request, 5.0)
        assert SHUTTER.reply("front", reply) == ShutterReply(camera="front", closed=False)
    eventually("another opening", lambda: len(infos) >= 3)
    numbers = [SKELETONS.decode(each.payload).sequence for each in heard]
    assert numbers == sorted(set(numbers))
    assert daemon.stop() == 0


@pytest.mark.long
def test_a_camera_that_does_not_run_starts_with_the_shutter_as_it_was_asked_for(
    rig: RunningRig, plugin_folder: Path
) -> None:
    rig.configure('[capture.front]\nsource = "scripted"\n')
    code, said = _told(rig, "shutter", "close", "--seconds", "1")
    assert code == 1
    assert "front does not answer: it does not run, or cannot be reached" in said
    daemon = _start(rig, plugin_folder)
    daemon.said("the shutter is closed: nothing is captured")
    assert daemon.stop() == 0


@pytest.mark.long
def test_a_camera_that_is_not_configured_is_refused(rig: RunningRig) -> None:
    rig.configure('[capture.front]\nsource = "simulator"\n')
    done = rig.done("shutter", "close", "--camera", "frnt", "--config", rig.config)
    assert done.popen.returncode == 2
    assert "there is no table [capture.frnt] (did you mean front?)" in done.stderr
