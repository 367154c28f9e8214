"""A running `inhand up` takes over its settings file, and a bad one changes nothing."""

import os
import pty
import signal
import subprocess
import sys
import termios
from collections.abc import Callable
from fcntl import ioctl
from pathlib import Path

import psutil
import pytest
from inhand_runtime.settings import load_rig_file
from running_rig import Process, RunningRig, eventually

from inhand.__main__ import main
from inhand.rig_processes import rig_processes

pytestmark = pytest.mark.long


def _recorders(rig: RunningRig, *lines: str, **folders: str) -> None:
    """Write settings of recorders, by their names and folders."""
    tables = [
        f'[recorder.{name}]\nfolder = "{rig.folder}/{folder}"' for name, folder in folders.items()
    ]
    rig.configure("\n".join((*lines, *tables)))


def _pids(up: Process) -> dict[str, int]:
    """The processes of the instances that run, by name."""
    running = {}
    for child in psutil.Process(up.pid).children():
        words = child.cmdline()
        if "--name" in words and "--check-config" not in words:
            running[words[words.index("--name") + 1]] = child.pid
    return running


def _started(rig: RunningRig, **folders: str) -> Process:
    _recorders(rig, **folders)
    up = rig.inhand("up", "--config", rig.config)
    for name in folders:
        up.said(f"recorder {name} is up")
    return up


def _reload(rig: RunningRig) -> Process:
    return rig.done("reload", "--config", rig.config)


def _by_the_verb(rig: RunningRig, _up: Process) -> None:
    assert _reload(rig).popen.returncode == 0


def _by_sighup(_rig: RunningRig, up: Process) -> None:
    up.popen.send_signal(signal.SIGHUP)


@pytest.mark.parametrize("ask", [_by_the_verb, _by_sighup])
def test_only_what_changed_starts_anew(
    rig: RunningRig, ask: Callable[[RunningRig, Process], None]
) -> None:
    up = _started(rig, a="first", b="second")
    before = _pids(up)
    _recorders(rig, a="first", b="third")
    ask(rig, up)
    eventually("b again", lambda: up.stderr.count("recorder b is up") == 2)
    assert "reload: starts anew: recorder b" in up.stderr
    assert "reload: goes on: recorder a" in up.stderr
    after = _pids(up)
    assert after["a"] == before["a"]
    assert after["b"] != before["b"]
    eventually("its new folder", (rig.folder / "third").is_dir)
    assert up.stop() == 0


def test_processes_come_and_go_with_their_tables(rig: RunningRig) -> None:
    up = _started(rig, a="first", b="second")
    kept = _pids(up)["b"]
    _recorders(rig, b="second", c="third")
    done = _reload(rig)
    assert done.popen.returncode == 0
    assert done.stdout.splitlines() == [
        "stops: recorder a",
        "starts: recorder c",
        "goes on: recorder b",
    ]
    up.said("recorder c is up")
    assert _pids(up).keys() == {"b", "c"}
    assert _pids(up)["b"] == kept
    assert up.stop() == 0
    assert up.stderr.count("recorder b is up") == 1


def test_a_camera_starts_anew_when_only_its_calibration_changed(tmp_path: Path) -> None:
    config, calibration = tmp_path / "rig.toml", tmp_path / "cameras.toml"
    config.write_text('[capture.front]\nsource = "x"\ncalibration = "cameras.toml"\n')
    calibration.write_text("version = 1")
    before = rig_processes(load_rig_file(config), config)
    assert rig_processes(load_rig_file(config), config) == before
    calibration.write_text("version = 1 # another one")
    assert rig_processes(load_rig_file(config), config) != before


BAD = {
    "no TOML": ("[recorder", "is no TOML"),
    "a typo": ('[recorder.a]\nfoldr = "x"', "unknown setting recorder.a.foldr"),
    "not startable": ('[recorder.a]\nfolder = "/proc/nowhere"', "cannot write to the folder"),
    "another rig": ('rig = "attic"\n[recorder.a]', "rig cannot change while `inhand up` runs"),
    "nothing": ("", "names no process"),
    "a camera that is gone": (
        '[capture.front]\nsource = "simulator"\n[tracker.mug]\ncamera = "frnt"\nmodel = "x"',
        "there is no table [capture.frnt]",
    ),
}


def test_a_bad_file_is_refused_and_what_runs_goes_on(rig: RunningRig) -> None:
    up = _started(rig, a="first", b="second")
    before = _pids(up)
    for text, said in BAD.values():
        rig.configure(text)
        done = _reload(rig)
        assert done.popen.returncode == 2, text
        assert said in done.stderr
        assert "nothing was changed" in done.stderr
        assert done.stdout == ""
    assert _pids(up) == before
    _recorders(rig, a="first", b="second", c="third")
    assert _reload(rig).popen.returncode == 0
    up.said("recorder c is up")
    assert _pids(up) | before == _pids(up)
    assert up.stop() == 0


@pytest.mark.parametrize("changed", ["[recorder", "", None], ids=["wrong", "empty", "gone"])
def test_what_dies_while_the_file_is_being_changed_starts_with_what_was_accepted(
    rig: RunningRig, changed: str | None
) -> None:
    up = _started(rig, a="first", b="second")
    kept = _pids(up)["b"]
    if changed is None:
        rig.config.unlink()
    else:
        rig.config.write_text(changed)
    os.kill(_pids(up)["a"], signal.SIGKILL)
    eventually("a again", lambda: up.stderr.count("recorder a is up") == 2)
    assert _pids(up)["b"] == kept
    assert up.stop() == 0


def test_what_was_not_reloaded_is_not_taken_over_by_what_dies(rig: RunningRig) -> None:
    up = _started(rig, a="first")
    eventually("a file", lambda: list(rig.folder.glob("first/*")))
    _recorders(rig, a="second")
    os.kill(_pids(up)["a"], signal.SIGKILL)
    eventually("a again", lambda: up.stderr.count("recorder a is up") == 2)
    eventually("files of both", lambda: len(list(rig.folder.glob("first/*"))) == 2)
    assert not (rig.folder / "second").exists()
    assert _reload(rig).stdout == "starts anew: recorder a\n"
    eventually("its new folder", (rig.folder / "second").is_dir)


def test_where_nothing_runs_that_is_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["reload", "--config", str(tmp_path / "rig.toml")]) == 1
    assert "no `inhand up` runs with" in capsys.readouterr().err


def _on_its_terminal() -> None:
    """What a child of a terminal does first; SIGHUP ends it, also where tests run without one."""
    ioctl(0, termios.TIOCSCTTY, 0)
    signal.signal(signal.SIGHUP, signal.SIG_DFL)


def test_a_terminal_that_closes_ends_it_as_ever(rig: RunningRig) -> None:
    """SIGHUP is what a closed terminal sends too, and nobody would see what goes on."""
    _recorders(rig, a="first")
    ours, theirs = pty.openpty()
    with (rig.folder / "log").open("wb") as output:
        up = subprocess.Popen(
            [sys.executable, "-m", "inhand", "up", "--config", str(rig.config)],
            stdin=theirs,
            stdout=output,
            stderr=output,
            start_new_session=True,
            preexec_fn=_on_its_terminal,
        )
    try:
        os.close(theirs)
        log = rig.folder / "log"
        eventually("it is up", lambda: "recorder a is up" in log.read_text())
        children = psutil.Process(up.pid).children()
        _recorders(rig, a="second")
        up.send_signal(signal.SIGHUP)  # the terminal is still there
        eventually("a again", lambda: log.read_text().count("recorder a is up") == 2)
        os.close(ours)
        assert up.wait(30) == 0
        assert psutil.wait_procs(children, timeout=10)[1] == []
    finally:
        up.kill()
        up.wait()
