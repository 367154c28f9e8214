"""``inhand hub init``, ``add``, …: what they print can be done as it stands."""

import re
from pathlib import Path

import pytest
from inhand_hub.service import check
from inhand_hub.settings import HubSettings
from inhand_lab.demonstration.preparation import free_port
from inhand_runtime.errors import SettingsError
from inhand_runtime.hub_access import require_client, require_usable
from inhand_runtime.settings import load_rig_file, load_settings
from running_rig import RunningRig

from inhand.__main__ import main

INIT = ["hub", "init", "site", "--realm", "home", "--rigs", "kitchen"]


@pytest.fixture(autouse=True)
def _here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def settings_in(text: str) -> str:
    """The settings that a command prints."""
    lines = text.splitlines()
    first = next(i for i, line in enumerate(lines) if line.startswith("realm = "))
    last = max(i for i, line in enumerate(lines) if re.match(r"\w+ = |\[", line))
    return "\n".join(lines[first : last + 1])


def test_the_hub_runs_with_what_init_prints(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(INIT) == 0
    Path("hub.toml").write_text(settings_in(capsys.readouterr().out))
    settings = load_settings(Path("hub.toml"), "hub", HubSettings)
    assert settings.service.listen == ("tls/127.0.0.1:7448",)
    check(settings)
    assert main(["hub", "--config", "hub.toml", "--check-config"]) == 0


@pytest.mark.parametrize(
    ("arguments", "table"),
    [
        (["camera", "front"], "capture"),
        (["tracker", "follower", "--objects", "mug", "pan"], "tracker"),
        (["recorder", "disk"], "recorder"),
        (["studio", "desk"], "studio"),
        (["viewer", "anna"], None),
    ],
)
def test_a_member_connects_with_what_add_prints(
    arguments: list[str], table: str | None, capsys: pytest.CaptureFixture[str]
) -> None:
    main([*INIT, "--hosts", "hub.local", "192.168.1.10"])
    assert 'listen = ["tls/0.0.0.0:7448"]' in capsys.readouterr().out
    assert main(["hub", "add", *arguments]) == 0
    folder = Path("site/members")
    (folder / "member.toml").write_text(settings_in(capsys.readouterr().out))
    rig_file = load_rig_file(folder / "member.toml")
    assert (rig_file.realm, rig_file.rig) == ("home", "kitchen")
    assert rig_file.zenoh.connect == ("tls/hub.local:7448",)
    assert rig_file.zenoh.credentials is not None
    require_usable(rig_file.zenoh.credentials)
    if table is not None:
        assert list(getattr(rig_file, table)) == [arguments[1]]


def test_a_further_hub_runs_with_what_add_prints(capsys: pytest.CaptureFixture[str]) -> None:
    main([*INIT, "--hosts", "hub.local"])
    main(["hub", "add", "camera", "front"])
    capsys.readouterr()
    assert main(["hub", "add", "hub", "barn", "--hosts", "barn.local", "--far"]) == 0
    Path("site/hubs/barn.toml").write_text(settings_in(capsys.readouterr().out))
    settings = load_settings(Path("site/hubs/barn.toml"), "hub", HubSettings)
    assert settings.service.listen == ("tls/0.0.0.0:7448",)
    assert settings.service.connect == ("tls/hub.local:7448",)
    site = check(settings)
    assert [one.name for one in site.members] == ["front"]
    assert [one.far for one in site.hubs] == [True]
    assert main(["hub", "renew", "barn"]) == 0
    assert "copy site/hubs/barn/certificate.pem" in capsys.readouterr().out
    assert main(["hub", "revoke", "barn"]) == 0
    assert "revoked hub barn" in capsys.readouterr().out


def test_a_member_with_a_password_connects_with_what_add_prints(
    capsys: pytest.CaptureFixture[str],
) -> None:
    main(INIT)
    assert main(["hub", "add", "viewer", "anna", "--password"]) == 2
    assert "`inhand hub add hub NAME --passwords`" in capsys.readouterr().err
    main(["hub", "add", "hub", "guests", "--hosts", "hub.local", "--passwords"])
    capsys.readouterr()
    assert main(["hub", "add", "viewer", "anna", "--password"]) == 0
    printed = capsys.readouterr().out
    folder = Path("site/members/kitchen.anna")
    password = (folder / "password").read_text().strip()
    assert len(password) >= 32
    assert password not in printed
    assert sorted(one.name for one in folder.iterdir()) == ["authority.pem", "password"]
    (folder.parent / "anna.toml").write_text(settings_in(printed))
    zenoh = load_rig_file(folder.parent / "anna.toml").zenoh
    assert zenoh.connect == ("tls/hub.local:7448",)
    require_client(zenoh)
    users = Path("site/hubs/guests/users").read_text().splitlines()
    assert f"{zenoh.user}:{password}" in users
    assert main(["hub", "renew", "anna"]) == 0
    assert password not in Path("site/hubs/guests/users").read_text()
    assert main(["hub", "revoke", "anna"]) == 0
    assert len(Path("site/hubs/guests/users").read_text().splitlines()) == 1


@pytest.mark.parametrize(
    ("users", "words"),
    [
        (None, "cannot read .*users: No such file"),
        ("nobody:x\n", "has no password of kitchen.anna"),
    ],
)
def test_a_hub_whose_users_are_not_its_members_does_not_start(
    users: str | None, words: str
) -> None:
    main(INIT)
    main(["hub", "add", "hub", "guests", "--passwords"])
    main(["hub", "add", "viewer", "anna", "--password"])
    path = Path("site/hubs/guests/users")
    if users is None:
        path.unlink()
    else:
        path.write_text(users)
    Path("hub.toml").write_text(
        'realm = "home"\nrig = "kitchen"\n[hub.guests]\nfolder = "site/hubs/guests"\n'
    )
    with pytest.raises(SettingsError, match=words):
        check(load_settings(Path("hub.toml"), "hub", HubSettings))


def test_renewal_and_revocation_say_what_is_to_be_done(capsys: pytest.CaptureFixture[str]) -> None:
    main(INIT)
    main(["hub", "add", "camera", "front"])
    capsys.readouterr()
    assert main(["hub", "renew", "front"]) == 0
    assert "copy site/members/kitchen.front/certificate.pem" in capsys.readouterr().out
    assert main(["hub", "renew", "hub"]) == 0
    assert "copy site/hub/certificate.pem" in capsys.readouterr().out
    assert main(["hub", "revoke", "front"]) == 0
    assert "copy site/hub/members.json" in capsys.readouterr().out
    assert not list(Path("site/members").iterdir())


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (INIT, "site is there already"),
        (["hub", "init", "s", "--realm", "My Home", "--rigs", "a"], "realm 'My Home' is no name"),
        (["hub", "init", "s", "--realm", "home", "--rigs", "a/**"], "rig 'a/\\*\\*' is no name"),
        (["hub", "add", "camera", "Front"], "name 'Front' is no name"),
        (["hub", "add", "tracker", "m", "--objects", "*"], "object '\\*' is no name"),
        (["hub", "add", "camera", "front", "--objects", "mug"], "publishes no poses"),
        (["hub", "add", "camera", "front", "--site", "nowhere"], "cannot read nowhere"),
        (["hub", "revoke", "nobody"], "there is no member 'nobody'"),
        (["hub", "add", "camera", "front", "--far"], "are for `inhand hub add hub`"),
        (["hub", "add", "hub", "barn", "--rig", "kitchen"], "a hub is of no rig"),
    ],
)
def test_what_cannot_be_done_is_one_line_and_code_2(
    arguments: list[str], words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    main(INIT)
    capsys.readouterr()
    assert main(arguments) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("inhand hub: ")
    assert re.search(words, line)


def test_no_key_is_printed(capsys: pytest.CaptureFixture[str]) -> None:
    main(INIT)
    main(["hub", "add", "camera", "front"])
    printed = "".join(capsys.readouterr())
    for path in Path("site").rglob("key.pem"):
        assert path.read_text().splitlines()[1] not in printed


def test_up_runs_a_hub_before_the_member_of_its_settings(
    rig: RunningRig, capsys: pytest.CaptureFixture[str]
) -> None:
    main(INIT)
    hub = settings_in(capsys.readouterr().out)
    main(["hub", "add", "recorder", "disk"])
    member = settings_in(capsys.readouterr().out).replace(
        "kitchen.disk/", "site/members/kitchen.disk/"
    )
    both = member + "\n" + hub[hub.index("[hub.hub]") :]
    rig.config.write_text(both.replace(":7448", f":{free_port()}"))
    up = rig.inhand("up", "--config", rig.config)
    up.said("recorder disk is up")
    assert up.stderr.index("hub hub is up") < up.stderr.index("recorder disk is up")
    assert up.stop() == 0
    assert up.stderr.index("recorder disk stopped") < up.stderr.index("hub hub stopped")


def test_up_says_what_to_do_where_its_processes_would_not_meet_at_the_hub(
    capsys: pytest.CaptureFixture[str],
) -> None:
    Path("rig.toml").write_text("[hub.hub]\n[recorder.disk]\n")
    assert main(["up", "--config", "rig.toml"]) == 2
    assert "let each join (`inhand hub add`)" in capsys.readouterr().err
