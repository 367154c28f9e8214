"""A site with a hub that runs, and members of each role, made by Inhand's own code."""

import contextlib
import socket
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import zenoh
from examples import EXAMPLES
from inhand_hub.access import Member, RoleName
from inhand_hub.site_folder import SiteFolder, create_site
from inhand_runtime.inbox import Received
from inhand_runtime.session import open_session
from inhand_runtime.settings import ZenohSettings
from inhand_schemas.keys import Site
from inhand_schemas.topics import AnyTopic
from running_rig import Process, RunningRig, eventually
from wire import Wire

REALM, RIG, OTHER_RIG = "home", "kitchen", "garage"
SITE = Site(REALM, RIG)
PEOPLE: dict[str, RoleName] = {
    "front": "camera",
    "back": "camera",
    "mug": "tracker",
    "disk": "recorder",
    "desk": "studio",
    "anna": "viewer",
    "home": "outcomes",
}
"""Who belongs to the rig, by name, with the role."""


def free_address() -> str:
    """Return an encrypted address of this machine that nobody listens on."""
    with socket.socket() as server:
        server.bind(("127.0.0.1", 0))
        return f"tls/127.0.0.1:{server.getsockname()[1]}"


def made_site(path: Path) -> SiteFolder:
    """Make a site of two rigs, and let everybody join."""
    folder = create_site(path, REALM, (RIG, OTHER_RIG), ("localhost", "127.0.0.1"))
    for name, role in PEOPLE.items():
        folder.add(role, name, RIG, ("mug",) if role == "tracker" else ())
    folder.add("viewer", "stranger", OTHER_RIG, ())
    return folder


@dataclass
class HubSite:
    """A site whose hub runs in a process of its own."""

    folder: SiteFolder
    rig: RunningRig
    address: str
    hub: Process

    def settings(self, name: str) -> ZenohSettings:
        """How a member reaches the hub."""
        return self.settings_of(self.folder.folder_of(self.member(name)))

    def settings_of(self, given: Path) -> ZenohSettings:
        """How whoever has the files of a folder reaches the hub."""
        return ZenohSettings(
            mode="client",
            connect=(self.address,),
            certificate=given / "certificate.pem",
            key=given / "key.pem",
            authority=given / "authority.pem",
        )

    def member(self, name: str) -> Member:
        """A member by its name."""
        return self.folder.load().find(name)

    @contextlib.contextmanager
    def joined(self, name: str) -> Iterator[Wire]:
        """A session of this process in the name of a member."""
        with self.joined_by(self.settings(name)) as wire:
            yield wire

    @contextlib.contextmanager
    def joined_by(self, settings: ZenohSettings) -> Iterator[Wire]:
        """A session of this process with certain files."""
        with open_session(settings) as session:
            yield Wire(session, SITE)

    def config(self, name: str, lines: str = "", site: Site = SITE) -> Path:
        """Write the settings file of a member, with lines of its own."""
        settings = self.settings(name)
        path = self.rig.folder / f"{name}.toml"
        path.write_text(
            f'realm = "{site.realm}"\nrig = "{site.rig}"\n[zenoh]\nmode = "client"\n'
            f'connect = ["{self.address}"]\ncertificate = "{settings.certificate}"\n'
            f'key = "{settings.key}"\nauthority = "{settings.authority}"\n{lines}\n'
        )
        return path

    def started_again(self) -> "HubSite":
        """Start a hub that has ended, where it was."""
        return _started(self.rig, self.folder, self.address, "hub", self.folder.hub)

    def restarted(self, times: int) -> None:
        """Wait until the hub has started so often."""
        eventually(
            f"start {times} of the hub", lambda: self.hub.stderr.count("may connect") >= times
        )


def start_hub(rig: RunningRig, folder: SiteFolder) -> HubSite:
    """Run a site's hub on a free port."""
    return _started(rig, folder, free_address(), "hub", folder.hub)


def linked_hub(first: HubSite, name: str) -> HubSite:
    """Run a further hub, which connects to the first."""
    given, connect = first.folder.folder_of_hub(name), f'connect = ["{first.address}"]'
    return _started(first.rig, first.folder, free_address(), name, given, connect)


def _started(
    rig: RunningRig, folder: SiteFolder, address: str, name: str, given: Path, lines: str = ""
) -> HubSite:
    config = rig.folder / f"{name}.toml"
    config.write_text(
        f'realm = "{REALM}"\nrig = "{RIG}"\n'
        f'[hub.{name}]\nfolder = "{given}"\nlisten = ["{address}"]\n{lines}\n'
    )
    hub = rig.inhand("hub", "--config", config)
    hub.said("may connect")
    return HubSite(folder, rig, address, hub)


def message_of(topic: AnyTopic) -> Any:
    """A message of a topic's type."""
    return next(one for one in EXAMPLES if isinstance(one, topic.message_type))


def short_keys(samples: Sequence[Received]) -> set[str]:
    """The keys of samples, as ``stream/name`` of this rig."""
    return {sample.key.removeprefix(f"{REALM}/@v1/{RIG}/") for sample in samples}


def listening(session: zenoh.Session, *patterns: str) -> tuple[list[str], list[Any]]:
    """Return the growing list of keys that others publish on, and what must be kept for more."""
    keys: list[str] = []

    def note(sample: zenoh.Sample) -> None:
        keys.append(str(sample.key_expr))

    remote = zenoh.Locality.REMOTE
    return keys, [session.declare_subscriber(one, note, allowed_origin=remote) for one in patterns]
