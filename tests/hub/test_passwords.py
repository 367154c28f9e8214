"""Members that join by user and password, at a hub that takes them."""

import contextlib
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
import zenoh
from hub_site import (
    RIG,
    SITE,
    HubSite,
    linked_hub,
    listening,
    made_site,
    message_of,
    short_keys,
    start_hub,
)
from inhand_runtime import zenoh_config
from inhand_runtime.errors import InhandError
from inhand_runtime.session import open_session
from inhand_runtime.settings import ZenohSettings
from inhand_schemas.topics import INFO, SKELETONS, TOPICS
from running_rig import RunningRig, eventually


@pytest.fixture(scope="module")
def hubs(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[HubSite, HubSite]]:
    """The first hub of a site, and one for passwords with a camera and a viewer."""
    folder = tmp_path_factory.mktemp("passwords")
    with contextlib.closing(RunningRig(folder)) as rig:
        site = made_site(folder / "site")
        site.add_hub("guests", ("localhost", "127.0.0.1"), passwords=True)
        site.add("camera", "side", RIG, (), by_password=True)
        site.add("viewer", "guest", RIG, (), by_password=True)
        house = start_hub(rig, site)
        yield house, linked_hub(house, "guests")


def login(hub: HubSite, name: str, password: Path | None = None) -> ZenohSettings:
    """How a member with a password reaches a hub, or with the password of another file."""
    member = hub.member(name)
    given = hub.folder.folder_of(member)
    return ZenohSettings(
        mode="client",
        connect=(hub.address,),
        user=member.common_name,
        password=password or given / "password",
        authority=given / "authority.pem",
    )


def test_they_do_what_their_role_may_and_no_more(hubs: tuple[HubSite, HubSite]) -> None:
    house, guests = hubs
    with (
        guests.joined_by(login(guests, "side")) as camera,
        guests.joined_by(login(guests, "guest")) as viewer,
        house.joined("desk") as desk,
    ):
        heard = {topic.stream: desk.hear(topic) for topic in TOPICS.values()}
        seen = viewer.hear(SKELETONS)
        keys, handles = listening(camera.session, "**", SKELETONS.pattern(SITE))

        def came() -> bool:
            for topic in TOPICS.values():
                for name in ("side", "front", "mug"):
                    payload = topic.encode(message_of(topic))
                    for wire in (camera, viewer):
                        wire.session.put(topic.key(SITE, name), payload, encoding=topic.encoding)
            return bool(heard["skeletons"] and heard["rgbd"] and seen)

        eventually("what the camera publishes", came)
        got = set[str]().union(*map(short_keys, heard.values()))
        own = {f"{stream}/side" for stream in ("info", "rgbd", "skeletons", "preview", "health")}
        assert got - {"health/hub", "health/guests"} <= own
        assert not keys
        del handles


def test_a_daemon_runs_with_user_and_password_that_nobody_else_sees(
    hubs: tuple[HubSite, HubSite], tmp_path: Path
) -> None:
    _, guests = hubs
    given = login(guests, "side")
    config = tmp_path / "side.toml"
    config.write_text(
        f'realm = "{SITE.realm}"\nrig = "{RIG}"\n[log]\nlevel = "debug"\n[zenoh]\nmode = "client"\n'
        f'connect = ["{guests.address}"]\nuser = "{given.user}"\npassword = "{given.password}"\n'
        f'authority = "{given.authority}"\n[capture.side]\nsource = "simulator"\n'
    )
    camera = guests.rig.inhand("capture", "--config", config, RUST_LOG="debug")
    with guests.joined_by(login(guests, "guest")) as viewer:
        infos = viewer.hear(INFO)
        eventually("its info", lambda: infos)
    assert given.password is not None
    password = given.password.read_text().strip()
    for pid in (camera.pid, guests.hub.pid):
        for name in ("cmdline", "environ"):
            assert password not in Path(f"/proc/{pid}/{name}").read_text()
    camera.stop()
    for process in (camera, guests.hub):
        assert password not in process.stdout + process.stderr


def test_who_has_no_password_of_the_site_is_told_so_and_reaches_nothing(
    hubs: tuple[HubSite, HubSite], tmp_path: Path
) -> None:
    house, guests = hubs
    wrong = tmp_path / "password"
    wrong.write_text("guess\n")
    refused = {
        "does not take this user with this password": login(guests, "side", wrong),
        "lets nobody in by password": login(house, "side"),
        "not one for members with passwords": guests.settings("front"),
    }
    for words, settings in refused.items():
        with pytest.raises(InhandError, match=words):
            opened(settings)
    bare = zenoh_config.zenoh_config(
        {
            "mode": "client",
            "connect/endpoints": [guests.address],
            "connect/timeout_ms": 1500,
            "transport/link/tls": {
                "root_ca_certificate": str(login(guests, "side").authority),
                "verify_name_on_connect": True,
            },
        }
    )
    with pytest.raises(zenoh.ZError):
        zenoh.open(bare)


def test_a_password_that_was_renewed_or_revoked_counts_no_more(
    hubs: tuple[HubSite, HubSite], tmp_path: Path
) -> None:
    _, guests = hubs
    guests.folder.add("viewer", "friend", RIG, (), by_password=True)
    guests.restarted(2)
    settings = login(guests, "friend")
    assert settings.password is not None
    before = tmp_path / "password"
    shutil.copy(settings.password, before)
    opened(settings)
    assert guests.folder.renew("friend") == settings.password
    guests.restarted(3)
    with pytest.raises(InhandError, match="was it renewed"):
        opened(login(guests, "friend", before))
    opened(settings)
    kept = shutil.copytree(settings.password.parent, tmp_path / "kept")
    guests.folder.revoke("friend")
    guests.restarted(4)
    files = {"password": kept / "password", "authority": kept / "authority.pem"}
    with pytest.raises(InhandError, match="does not take this user"):
        opened(settings.model_copy(update=files))


def opened(settings: ZenohSettings) -> None:
    with open_session(settings):
        pass
