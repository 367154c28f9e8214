"""Whoever looks at ``inhand status`` sees what is wrong, whatever it is."""

import json
import os
import signal
import time

import psutil
import pytest
from inhand_schemas.messages import Health, RgbdFrame, Skeletons, TopicHealth
from inhand_schemas.topics import HEALTH, POSE, RGBD, SKELETONS
from msgspec.structs import replace
from played import entries, write
from running_rig import RunningRig, eventually
from wire import Wire


def status(rig: RunningRig, seconds: float = 6.0) -> tuple[int, list[str]]:
    """The exit code of a look, and what it says is wrong."""
    result = rig.folder / "status.json"
    looked = rig.done("status", "--config", rig.config, "--seconds", str(seconds), "--json", result)
    problems = json.loads(result.read_text())["problems"]
    assert all(f"WRONG: {line}" in looked.stdout for line in problems)
    return looked.popen.returncode, problems


def recorder(rig: RunningRig, more: str = "") -> None:
    rig.configure(f'[recorder.disk]\nfolder = "{rig.folder}/disk"\n{more}')


def test_a_site_where_all_is_well_exits_with_0(rig: RunningRig) -> None:
    recorder(rig)
    rig.inhand("recorder", "--config", rig.config).said("is up")
    assert status(rig) == (0, [])


def test_whom_the_settings_name_and_who_does_not_run_is_missing(rig: RunningRig) -> None:
    recorder(rig, '[tracker.mug]\nmodel = "mug.model"')
    rig.inhand("recorder", "--config", rig.config).said("is up")
    code, problems = status(rig, 3.0)
    assert code == 1
    assert problems == ["tracker mug is missing: it does not run, or cannot be reached from here"]


@pytest.mark.long
def test_a_stopped_process_is_said_to_hang(rig: RunningRig) -> None:
    recorder(rig)
    daemon = rig.inhand("recorder", "--config", rig.config)
    daemon.said("is up")
    daemon.popen.send_signal(signal.SIGSTOP)
    code, problems = status(rig, 4.0)
    daemon.popen.send_signal(signal.SIGCONT)
    assert code == 1
    (line,) = problems
    assert line.startswith("recorder disk hangs, or is stopped")


@pytest.mark.long
def test_a_stopped_replay_is_said_to_hang_though_no_settings_name_it(
    wire: Wire, rig: RunningRig
) -> None:
    recorder(rig)
    rig.inhand("recorder", "--config", rig.config).said("is up")
    walk = write(rig.folder / "walk.mcap", entries(30))
    heard = wire.hear(RGBD)
    replay = rig.inhand("replay", walk, "--loop", "--config", rig.config)
    eventually("frames", lambda: heard)
    replay.popen.send_signal(signal.SIGSTOP)
    code, problems = status(rig)
    replay.popen.send_signal(signal.SIGCONT)
    assert code == 1
    (line,) = problems
    assert line.startswith(f"`inhand replay {walk} --loop ")
    assert "hangs, or is stopped" in line


def test_a_second_instance_of_one_name_refuses_to_start(rig: RunningRig) -> None:
    recorder(rig)
    rig.inhand("recorder", "--config", rig.config).said("is up")
    second = rig.inhand("recorder", "--config", rig.config)
    assert second.wait() == 1
    assert "recorder disk runs already in rig 'rig' of realm 'inhand'" in second.stderr


@pytest.mark.long
def test_two_that_publish_under_one_name_are_told(wire: Wire, rig: RunningRig) -> None:
    recorder(rig)
    rig.inhand("recorder", "--config", rig.config).said("is up")
    heard = wire.hear(HEALTH)
    namesake = wire.publisher(HEALTH, "disk")
    eventually("health", lambda: heard)
    false = replace(HEALTH.decode(heard[0].payload), uptime_s=0.0)

    def told() -> bool:
        namesake.put(false)
        return any(
            "two instances have one name" in trouble
            for sample in heard[-3:]
            for trouble in HEALTH.decode(sample.payload).troubles
        )

    eventually("the trouble", told)


@pytest.mark.long
def test_messages_that_never_decode_are_a_trouble_of_now(wire: Wire, rig: RunningRig) -> None:
    recorder(rig)
    rig.inhand("recorder", "--config", rig.config).said("is up")
    key = SKELETONS.key(wire.site, "front")
    publisher = wire.publisher(SKELETONS, "front")
    eventually("the reader", publisher.wanted)
    publisher.put(Skeletons(sequence=0, time_ns=time.time_ns()))
    heard = wire.hear(HEALTH)

    def last() -> Health | None:
        return HEALTH.decode(heard[-1].payload) if heard else None

    def degraded() -> bool:
        wire.session.put(key, b"\xc1", encoding=SKELETONS.encoding)
        health = last()
        return health is not None and health.state == "degraded" and bool(health.troubles)

    eventually("degraded", degraded)
    code, problems = status(rig)
    assert code == 1
    assert "recorder disk: inhand/@v1/rig/skeletons/front: dropped a message" in problems[0]
    eventually("well again", lambda: last() is not None and last().state == "running")  # type: ignore[union-attr]
    assert status(rig) == (0, [])


@pytest.mark.long
def test_frames_without_their_cameras_info_are_a_trouble(wire: Wire, rig: RunningRig) -> None:
    recorder(rig)
    rig.inhand("recorder", "--config", rig.config).said("is up")
    frames = wire.publisher(RGBD, "front")
    eventually("the reader", frames.wanted)
    frames.put(RgbdFrame(sequence=0, time_ns=time.time_ns()))

    def told() -> bool:
        return "recorder disk: no camera info of front yet" in " ".join(status(rig)[1])

    eventually("the trouble", told)


@pytest.mark.long
def test_up_kills_and_starts_again_what_hangs(rig: RunningRig) -> None:
    recorder(rig)
    up = rig.inhand("up", "--config", rig.config)
    up.said("recorder disk is up")
    (child,) = psutil.Process(up.pid).children()
    rig.health("disk")
    os.kill(child.pid, signal.SIGSTOP)
    up.said("recorder disk has not come round")
    eventually(
        "another process",
        lambda: [one for one in psutil.Process(up.pid).children() if one.pid != child.pid],
    )
    eventually("it is well", lambda: status(rig) == (0, []))
    assert up.stop() == 0


@pytest.mark.long
def test_a_replay_under_a_running_cameras_name_is_refused(rig: RunningRig) -> None:
    played = write(rig.folder / "ten.mcap", entries(500))
    rig.configure(
        f'[capture.kitchen]\nsource = "replay"\n'
        f'options = {{ file = "{played}", loop = true }}\nwait_for_reader_s = 0'
    )
    rig.inhand("capture", "--config", rig.config).said("is up")
    second = rig.inhand("replay", played, "--config", rig.config)
    assert second.wait() == 1
    assert "capture kitchen runs already" in second.stderr


@pytest.mark.long
def test_two_who_publish_one_object_are_told(wire: Wire, rig: RunningRig) -> None:
    key = POSE.key(wire.site, "mug")
    traffic = {key: TopicHealth(published=9, rate_hz=30.0)}
    stamp = {"sequence": 0, "time_ns": 1, "service": "tracker", "state": "running"}
    tokens, publishers = [], []
    for name in ("one", "two"):
        health = Health(**stamp, instance=name, uptime_s=1.0, resident_bytes=1, topics=traffic)
        tokens.append(wire.session.liveliness().declare_token(wire.site.live_key("tracker", name)))
        publishers.append((wire.publisher(HEALTH, name), health))
    looking = rig.inhand("status", "--config", rig.config, "--seconds", "5")
    while looking.popen.poll() is None:
        for publisher, health in publishers:
            publisher.put(health)
        time.sleep(0.2)
    assert looking.popen.returncode == 1
    assert "pose/mug is published by tracker one and by tracker two" in looking.stdout
