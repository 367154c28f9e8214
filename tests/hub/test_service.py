"""What a hub's settings are checked for before it starts."""

from collections.abc import Callable
from pathlib import Path

import pytest
from hub_site import REALM, RIG
from inhand_hub.service import check
from inhand_hub.settings import HubSettings
from inhand_hub.site_folder import SiteFolder, create_site
from inhand_runtime.errors import SettingsError
from inhand_runtime.settings import load_settings


@pytest.fixture
def site(tmp_path: Path) -> SiteFolder:
    """A site with one camera."""
    folder = create_site(tmp_path / "site", REALM, (RIG,), ("localhost",))
    folder.add("camera", "front", RIG, ())
    return folder


def checked(site: SiteFolder, top: str, name: str = "hub", listen: str = "") -> None:
    config = site.path.parent / "hub.toml"
    config.write_text(f"{top}\n[hub.{name}]\n{listen}\n")
    check(load_settings(config, "hub", HubSettings))


def test_the_settings_that_init_says_are_valid(site: SiteFolder) -> None:
    checked(site, f'realm = "{REALM}"\nrig = "{RIG}"')


@pytest.mark.parametrize(
    ("top", "name", "words"),
    [
        ('realm = "other"\nrig = "kitchen"', "hub", "is of realm 'home' with rigs kitchen"),
        ('realm = "home"\nrig = "attic"', "hub", "is of realm 'home' with rigs kitchen"),
        ('realm = "home"\nrig = "kitchen"', "front", "a member of the site is named front"),
    ],
)
def test_a_site_that_is_not_the_settings_is_refused(
    site: SiteFolder, top: str, name: str, words: str
) -> None:
    with pytest.raises(SettingsError, match=words):
        checked(site, top, name)


def test_a_hub_that_connects_to_another_has_to_be_a_further_one(site: SiteFolder) -> None:
    top = f'realm = "{REALM}"\nrig = "{RIG}"'
    with pytest.raises(SettingsError, match="no further hub of that name: `inhand hub add hub"):
        checked(site, top, listen='connect = ["tls/hub.local:7448"]')
    with pytest.raises(SettingsError, match=r"hub\.connect.*'tcp/hub:7448' is not encrypted"):
        checked(site, top, listen='connect = ["tcp/hub:7448"]')


def test_a_hub_listens_to_nothing_that_is_not_encrypted(site: SiteFolder) -> None:
    with pytest.raises(SettingsError, match=r"hub\.listen.*'tcp/0.0.0.0:7447' is not encrypted"):
        checked(site, "", listen='listen = ["tcp/0.0.0.0:7447"]')


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (lambda hub: (hub / "members.json").unlink(), "make a site by `inhand hub init`"),
        (lambda hub: (hub / "members.json").write_text("{}"), "is no list of members"),
        (lambda hub: (hub / "key.pem").unlink(), "cannot read key"),
        (lambda hub: (hub / "certificate.pem").write_text("x"), "no pair of PEM files"),
    ],
)
def test_files_that_are_not_the_hub_s_are_refused(
    site: SiteFolder, spoil: Callable[[Path], object], words: str
) -> None:
    spoil(site.hub)
    with pytest.raises(SettingsError, match=words):
        checked(site, f'realm = "{REALM}"\nrig = "{RIG}"')


def test_a_file_of_users_that_others_may_read_is_warned_of(
    site: SiteFolder, caplog: pytest.LogCaptureFixture
) -> None:
    site.add_hub("guests", ("localhost",), passwords=True)
    given = site.folder_of_hub("guests")
    settings = f'folder = "{given}"\nconnect = ["tls/hub.local:7448"]'
    top = f'realm = "{REALM}"\nrig = "{RIG}"'
    checked(site, top, "guests", settings)
    assert not caplog.messages
    (given / "users").chmod(0o644)
    checked(site, top, "guests", settings)
    assert caplog.messages == [
        f"other users of this machine may read users {given / 'users'}: chmod 600"
    ]
