"""A router lets nobody do what no rule says, also where there is no rule at all."""

from pathlib import Path

import pytest
from examples import EXAMPLES
from hub_site import REALM, RIG, SITE, free_address, made_site
from inhand_hub.access import access_control
from inhand_hub.site_folder import SiteFolder, create_site
from inhand_runtime import zenoh_config
from inhand_runtime.errors import InhandError
from inhand_runtime.router import RouterSettings, open_router
from inhand_runtime.session import open_session, tokens
from inhand_runtime.settings import ZenohSettings
from inhand_schemas.topics import HEALTH
from running_rig import eventually
from wire import Wire

pytestmark = pytest.mark.long

MESSAGE = next(one for one in EXAMPLES if isinstance(one, HEALTH.message_type))


@pytest.fixture
def folder(tmp_path: Path) -> SiteFolder:
    """A site of which only the files are needed."""
    return made_site(tmp_path / "site")


def router_settings(folder: SiteFolder, address: str, *names: str) -> RouterSettings:
    """A router that knows these members only."""
    site, hub = folder.load(), folder.hub
    known = [site.find(name) for name in names]
    files = (hub / "certificate.pem", hub / "key.pem", hub / "authority.pem")
    return RouterSettings((address,), *files, access_control(site.realm, known), ())


def client_settings(folder: SiteFolder, address: str, name: str) -> ZenohSettings:
    given = folder.folder_of(folder.load().find(name))
    return ZenohSettings(
        mode="client",
        connect=(address,),
        certificate=given / "certificate.pem",
        key=given / "key.pem",
        authority=given / "authority.pem",
    )


@pytest.mark.parametrize("known", [(), ("anna",)], ids=["no rule at all", "rules of another"])
def test_who_is_no_member_sends_and_hears_nothing(
    folder: SiteFolder, known: tuple[str, ...]
) -> None:
    address = free_address()
    with (
        open_router(router_settings(folder, address, *known)) as router,
        open_session(client_settings(folder, address, "disk")) as stranger,
        open_session(client_settings(folder, address, "front")) as other,
    ):
        heard = Wire(router, SITE).hear(HEALTH)
        overheard = Wire(other, SITE).hear(HEALTH)
        for key in (HEALTH.key(SITE, "disk"), "some/key", HEALTH.pattern(SITE)):
            stranger.put(key, HEALTH.encode(MESSAGE), encoding=HEALTH.encoding)
        tokens(stranger, SITE.live_pattern())
        Wire(router, SITE).publisher(HEALTH, "hub").put(MESSAGE)
        eventually("the router's own", lambda: heard)
        assert [one.key for one in heard] == [HEALTH.key(SITE, "hub")]
        assert not overheard


def test_an_address_in_use_is_refused_with_the_mend(folder: SiteFolder) -> None:
    settings = router_settings(folder, free_address())
    with (
        open_router(settings),
        pytest.raises(InhandError, match=r"cannot listen on tls/.*in use"),
        open_router(settings),
    ):
        pass


def test_a_hub_of_another_address_than_its_certificate_s_is_not_trusted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(zenoh_config, "CLIENT_TIMEOUT_MS", 500)
    folder, address = create_site(tmp_path / "site", REALM, (RIG,), ("hub.local",)), free_address()
    folder.add("viewer", "anna", RIG, ())
    with (
        open_router(router_settings(folder, address, "anna")),
        pytest.raises(InhandError, match=r"cannot be trusted .*given as a host"),
        open_session(client_settings(folder, address, "anna")),
    ):
        pass
