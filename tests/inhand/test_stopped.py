"""A process that stands still is told from one that does not run."""

import signal

from inhand_runtime.roll import Roll
from inhand_runtime.settings import ZenohSettings
from running_rig import RunningRig, eventually

from inhand.instances import problems
from inhand.stopped import Stopped, stopped_services

RECORDER = Stopped(4711, "recorder", "disk", "inhand recorder --name disk")
UNNAMED = Stopped(4711, "recorder", None, "inhand recorder")
REPLAY = Stopped(4711, "capture", None, "inhand replay walk.mcap")


def problems_with(stopped: Stopped, *expected: tuple[str, str]) -> list[str]:
    return problems(Roll(), expected, [stopped])


def test_whom_the_settings_name_and_who_stands_still_hangs_and_is_not_missing() -> None:
    for stopped in (RECORDER, UNNAMED):
        assert problems_with(stopped, ("recorder", "disk")) == [
            "recorder disk hangs, or is stopped: process 4711 of this machine stands still; "
            "`kill -CONT 4711` lets it go on"
        ]


def test_one_command_without_a_name_is_none_of_two_that_are_missing() -> None:
    lines = problems_with(UNNAMED, ("recorder", "disk"), ("recorder", "tape"))
    assert [line.split(":")[0] for line in lines] == [
        "recorder disk is missing",
        "recorder tape is missing",
        "`inhand recorder` hangs, or is stopped",
    ]


def test_a_stopped_replay_is_named_by_its_command_though_no_settings_name_it() -> None:
    (line,) = problems_with(REPLAY)
    assert line.startswith("`inhand replay walk.mcap` hangs, or is stopped")


def test_one_that_lives_by_its_token_has_no_second_line() -> None:
    roll = Roll()
    roll.change("recorder", "disk", True)
    for stopped in (RECORDER, UNNAMED):
        (line,) = problems(roll, (), [stopped])
        assert line == "recorder disk hangs, or is stopped: it is there, and says nothing"


def test_a_stopped_daemon_is_found_at_its_meeting_address_and_at_no_other(rig: RunningRig) -> None:
    rig.configure(f'[recorder.disk]\nfolder = "{rig.folder}/disk"')
    daemon = rig.inhand("recorder", "--config", rig.config)
    daemon.said("is up")
    here = ZenohSettings(meeting=rig.meeting)
    assert stopped_services(here) == []
    daemon.popen.send_signal(signal.SIGSTOP)
    (found,) = eventually("the stopped process", lambda: stopped_services(here))
    assert (found.pid, found.service, found.name) == (daemon.pid, "recorder", None)
    assert stopped_services(ZenohSettings(meeting="tcp/127.0.0.1:1")) == []
    daemon.popen.send_signal(signal.SIGCONT)
