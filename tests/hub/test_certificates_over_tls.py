"""Certificates at a hub that runs: which it takes, and which it takes no longer."""

import datetime
import shutil
from pathlib import Path

import pytest
import zenoh
from hub_site import (
    PEOPLE,
    REALM,
    RIG,
    HubSite,
    message_of,
    short_keys,
)
from inhand_hub.certificates import (
    Issued,
    Validity,
    from_now,
    key_pem,
    load_issued,
    member_certificate,
    new_authority,
    new_key,
)
from inhand_runtime import session, zenoh_config
from inhand_runtime.errors import InhandError
from inhand_runtime.inbox import Received
from inhand_runtime.settings import ZenohSettings
from inhand_schemas.keys import Site
from inhand_schemas.topics import (
    HEALTH,
    SKELETONS,
)
from running_rig import eventually

pytestmark = pytest.mark.long


def authority_of(site: HubSite) -> Issued:
    folder = site.folder.path / "authority"
    return load_issued(*((folder / f"{name}.pem").read_bytes() for name in ("certificate", "key")))


def given(folder: Path, issued: Issued, trusted: bytes) -> Path:
    """Write the files that somebody connects with."""
    folder.mkdir()
    (folder / "certificate.pem").write_bytes(issued.certificate)
    (folder / "key.pem").write_bytes(key_pem(issued.key))
    (folder / "authority.pem").write_bytes(trusted)
    return folder


def ended() -> Validity:
    valid = from_now(1)
    return Validity(
        valid.begin - datetime.timedelta(days=9), valid.end - datetime.timedelta(days=2)
    )


def test_a_certificate_that_the_hub_does_not_take_gets_nobody_in(
    site: HubSite, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # The files are not looked at before: the hub itself must refuse them.
    monkeypatch.setattr(session, "require_client", lambda _settings: None)
    monkeypatch.setattr(zenoh_config, "CLIENT_TIMEOUT_MS", 500)
    authority, name = authority_of(site), site.member("front").common_name
    foreign, key = new_authority("Another one"), new_key()
    hub = site.folder.hub
    trusted = authority.certificate
    served = load_issued((hub / "certificate.pem").read_bytes(), (hub / "key.pem").read_bytes())
    cases = {
        "foreign": (member_certificate(foreign, name, key), "another authority"),
        "expired": (member_certificate(authority, name, key, ended()), "has expired"),
        "the hub's": (served, "the hub at"),
    }
    for case, (issued, words) in cases.items():
        settings = site.settings_of(given(tmp_path / case, issued, trusted))
        with pytest.raises(InhandError, match=words), site.joined_by(settings):
            pass


def test_without_a_certificate_or_without_tls_nobody_gets_in(
    site: HubSite, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(zenoh_config, "CLIENT_TIMEOUT_MS", 500)
    plain = ZenohSettings(mode="client", connect=(site.address.replace("tls/", "tcp/"),))
    with pytest.raises(InhandError, match="it may want tls"), site.joined_by(plain):
        pass
    authority = str(site.folder.hub / "authority.pem")
    bare = zenoh_config.zenoh_config(
        {
            "mode": "client",
            "connect/endpoints": [site.address],
            "connect/timeout_ms": 500,
            "transport/link/tls": {"root_ca_certificate": authority},
        }
    )
    with pytest.raises(zenoh.ZError):
        zenoh.open(bare)


def test_a_member_does_not_take_a_foreign_hub_for_its_own(
    site: HubSite, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(zenoh_config, "CLIENT_TIMEOUT_MS", 500)
    foreign = new_authority("Another one")
    issued = member_certificate(foreign, "kitchen.front.0", new_key())
    settings = site.settings_of(given(tmp_path / "given", issued, foreign.certificate))
    with pytest.raises(InhandError, match="cannot be trusted"), site.joined_by(settings):
        pass


def test_a_link_ends_with_its_certificate(site: HubSite, tmp_path: Path) -> None:
    now = datetime.datetime.now(datetime.UTC)
    soon = Validity(now - datetime.timedelta(hours=1), now + datetime.timedelta(seconds=4))
    issued = member_certificate(
        authority_of(site), site.member("front").common_name, new_key(), soon
    )
    folder = given(tmp_path / "given", issued, authority_of(site).certificate)
    with site.joined("disk") as recorder, site.joined_by(site.settings_of(folder)) as camera:
        heard = recorder.hear(SKELETONS)
        outlet = camera.publisher(SKELETONS, "front")

        def came() -> bool:
            outlet.put(message_of(SKELETONS))
            return bool(heard)

        eventually("a message while it is valid", came)
        eventually("the end of the link", lambda: not camera.session.info.routers_zid())
        with site.joined("back") as other:
            heard.clear()
            outlet.put(message_of(SKELETONS))
            other.publisher(SKELETONS, "back").put(message_of(SKELETONS))
            health = recorder.hear(HEALTH)
            eventually("the hub's health", lambda: health)
        assert "skeletons/front" not in short_keys(heard)


def test_what_the_settings_say_wrongly_is_said_before_anything_starts(site: HubSite) -> None:
    lines = {
        "another name": (site.config("disk", "[recorder.other]"), "as recorder other"),
        "another role": (site.config("front", "[recorder.front]"), "as recorder front"),
        "another rig": (
            site.config("desk", "[recorder.desk]", Site(REALM, "garage")),
            "of rig 'garage'",
        ),
    }
    started = [
        (site.rig.inhand("recorder", "--config", config), words) for config, words in lines.values()
    ]
    for process, words in started:
        assert process.wait() == 1
        assert process.stderr.count("\n") == 1
        assert words in process.stderr
        assert "lets the certificate" in process.stderr


def test_the_revoked_does_nothing_any_more_and_the_others_go_on(
    site: HubSite, tmp_path: Path
) -> None:
    site.folder.add("camera", "lent", RIG, ())
    site.restarted(2)
    member = site.member("lent")
    copied = shutil.copytree(site.folder.folder_of(member), tmp_path / "copied")
    thief = site.settings_of(copied)
    with site.joined_by(thief) as lent, site.joined("front") as camera, site.joined("disk") as disk:
        heard = disk.hear(SKELETONS)
        outlets = [lent.publisher(SKELETONS, "lent"), camera.publisher(SKELETONS, "front")]

        def came(*keys: str) -> bool:
            for outlet in outlets:
                outlet.put(message_of(SKELETONS))
            return short_keys(heard) >= set(keys)

        eventually("both cameras", lambda: came("skeletons/lent", "skeletons/front"))
        site.folder.revoke("lent")
        site.restarted(3)
        heard.clear()
        eventually("the other camera", lambda: came("skeletons/front"))
        # Zenoh has no list of revoked certificates: the link stands, and nothing goes through.
        eventually("its link", lent.session.info.routers_zid)
        more = len(heard) + 20
        eventually("more of the other", lambda: came() and len(heard) >= more)
        assert short_keys(heard) == {"skeletons/front"}
        strange = f"{member.common_name}, which is no member"
        health = disk.hear(HEALTH)
        eventually("its name in the hub's health", lambda: strange in _troubles(health))
    with site.joined("disk") as disk:
        health = disk.hear(HEALTH)
        eventually("a health without it", lambda: health and strange not in _troubles(health[-1:]))


def _troubles(healths: list[Received]) -> str:
    """All that healths call troubles."""
    return "\n".join(
        trouble for one in healths for trouble in HEALTH.decode(one.payload, one.encoding).troubles
    )


def test_nothing_secret_is_said(site: HubSite) -> None:
    secrets = {path.read_text().splitlines()[1] for path in site.folder.path.rglob("key.pem")}
    assert len(secrets) >= len(PEOPLE)
    said = site.hub.stderr + site.hub.stdout + repr(site.settings("front"))
    said += Path(f"/proc/{site.hub.pid}/cmdline").read_text()
    assert not any(secret in said for secret in secrets)


def test_a_list_that_cannot_be_read_changes_nothing_and_is_a_trouble(site: HubSite) -> None:
    path, anna = site.folder.hub / "members.json", site.settings("anna")
    whole = path.read_bytes()
    starts = site.hub.stderr.count("may connect")
    path.write_bytes(whole[:-20])
    site.hub.said("goes on with former members")
    with site.joined_by(anna) as viewer:
        heard = viewer.hear(HEALTH)
        eventually(
            "the trouble in its health",
            lambda: "is no list of members" in _troubles(heard),
        )
    path.write_bytes(whole)
    site.restarted(starts + 1)
    with site.joined("anna") as viewer:
        eventually("the hub", lambda: viewer.live() == ["hub/hub"])


def test_the_hub_stops_as_other_daemons_do(site: HubSite) -> None:
    assert site.hub.stop() == 0
    assert "hub hub stopped" in site.hub.stderr.splitlines()[-1]
