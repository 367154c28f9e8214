"""The sample settings are ones that the daemons take."""

import tomllib
from pathlib import Path

import pytest
from inhand_hub.site_folder import SiteFolder, create_site
from inhand_runtime.settings import SERVICES, instance_settings, load_rig_file

from inhand.__main__ import main
from inhand.deployment import deploy_folder
from inhand.service_models import settings_model

FOLDER = deploy_folder() / "settings"
SAMPLES = sorted(FOLDER.rglob("*.toml"))


def test_there_are_samples_of_each_kind() -> None:
    assert {path.name for path in FOLDER.iterdir()} == {
        "one_host.toml",
        "smart_home.toml",
        "three_hosts",
    }


@pytest.mark.parametrize("sample", SAMPLES, ids=lambda path: path.stem)
def test_a_sample_is_what_the_daemons_read(sample: Path) -> None:
    rig_file = load_rig_file(sample)
    instances = [(one, name) for one in SERVICES for name in getattr(rig_file, one)]
    assert instances
    for service, name in instances:
        instance_settings(rig_file, sample, service, settings_model(service), name)


@pytest.mark.parametrize(
    "sample", [one for one in SAMPLES if one.parent != FOLDER], ids=lambda path: path.stem
)
def test_a_member_s_unit_settings_and_key_have_one_name(sample: Path) -> None:
    rig_file = load_rig_file(sample)
    (service,) = [one for one in SERVICES if getattr(rig_file, one)]
    (name,) = getattr(rig_file, service)
    assert name == sample.stem
    unit = "inhand-hub" if service == "hub" else f"inhand-{service}@{name}"
    text = sample.read_text()
    assert f"systemctl enable --now {unit}`" in text
    assert f"/etc/credstore/inhand.{name}.key.pem" in text
    assert 'key = "$CREDENTIALS_DIRECTORY/key.pem"' in text
    file = unit.replace(f"@{name}", "@") + ".service"
    given = f"LoadCredential=key.pem:inhand.{name}.key.pem\n"
    assert given in (deploy_folder() / "systemd" / file).read_text().replace("%i", name)


@pytest.mark.long
def test_the_commands_of_the_samples_make_the_site_that_they_join(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Certificates are made as the samples say, and found where they look when copied there."""
    monkeypatch.chdir(tmp_path)
    texts = {one.stem: one.read_text() for one in SAMPLES if one.parent != FOLDER}
    hub = texts.pop("hub")
    for text in (hub, *texts.values()):
        line = next(line for line in text.splitlines() if "is made by: inhand " in line)
        assert main(line.partition("inhand ")[2].split()) == 0
    site = SiteFolder(Path("site")).load()
    for name, text in texts.items():
        settings = tomllib.loads(text)
        member = site.find(name)
        assert (member.rig, site.realm) == (settings["rig"], settings["realm"])
        folder = Path(settings["zenoh"]["certificate"]).parent.name
        assert (tmp_path / "site/members" / folder / "key.pem").exists()
    assert tomllib.loads(hub)["realm"] == site.realm
    assert (tmp_path / "site/hub/key.pem").exists()


def test_a_hub_s_key_may_be_where_systemd_puts_it(tmp_path: Path) -> None:
    create_site(tmp_path / "site", "home", ("kitchen",), ("localhost",))
    (tmp_path / "site/hub/key.pem").rename(tmp_path / "key.pem")
    config = tmp_path / "hub.toml"
    text = 'realm = "home"\nrig = "kitchen"\n[hub.hub]\nfolder = "site/hub"\n'
    config.write_text(text)
    assert main(["hub", "--config", str(config), "--check-config"]) == 2
    config.write_text(text + 'key = "key.pem"\n')
    assert main(["hub", "--config", str(config), "--check-config"]) == 0
