"""The hub's daemon: runs the router by the list of members, and anew when that changes."""

import contextlib
import logging
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from inhand_runtime.daemon import Daemon, running_daemon
from inhand_runtime.errors import InhandError, SettingsError
from inhand_runtime.hub_access import require_usable, warn_of_readers
from inhand_runtime.open_files import allow_many
from inhand_runtime.questions import answer
from inhand_runtime.router import RouterSettings, open_router
from inhand_runtime.session import Session
from inhand_runtime.settings import Credentials, Settings
from inhand_runtime.signals import set_on_signals
from inhand_runtime.wording import counted
from inhand_schemas.keys import Site

from inhand_hub.access import Member, access_control, deliveries
from inhand_hub.links import LinksWatch
from inhand_hub.members import (
    AUTHORITY_FILE,
    CERTIFICATE_FILE,
    KEY_FILE,
    MEMBERS_FILE,
    USERS_FILE,
    SiteMembers,
    load_members,
)
from inhand_hub.parameters import DEFAULT_HUB
from inhand_hub.settings import HubSettings

log = logging.getLogger(__name__)

State = tuple[tuple[int, int, int] | None, ...]
"""What tells the files of a hub from those that were there before: of each its identity, time of
change and size, or None while it is not there."""


def check(settings: Settings[HubSettings]) -> SiteMembers:
    """Read who belongs to the site, and check all files; raises SettingsError or InhandError."""
    site = load_members(settings.service.folder / MEMBERS_FILE)
    if settings.site.realm != site.realm or settings.site.rig not in site.rigs:
        raise SettingsError(
            f"{settings.service.folder} is of realm {site.realm!r} with rigs "
            f"{', '.join(site.rigs)}, and the settings say realm {settings.site.realm!r} and rig "
            f"{settings.site.rig!r}: set realm and rig"
        )
    if any(one.name == settings.instance for one in site.members):
        raise SettingsError(
            f"a member of the site is named {settings.instance}, as this hub: name it [hub.hub]"
        )
    hub = site.hub(settings.instance)
    if settings.service.connect and hub is None:
        raise SettingsError(
            f"hub.{settings.instance} connects to another hub, and the site has no further hub of "
            f"that name: `inhand hub add hub {settings.instance}`, or leave connect out"
        )
    if hub is not None and hub.passwords:
        _require_users(settings.service.folder / USERS_FILE, site.members_of(hub.name))
    require_usable(_credentials(settings), serves=True)
    return site


def _require_users(path: Path, members: Sequence[Member]) -> None:
    """Check that each member has a password; Zenoh lets all in where a file names nobody."""
    try:
        users = {line.partition(":")[0] for line in path.read_text(encoding="utf-8").splitlines()}
    except OSError as error:
        raise SettingsError(f"cannot read {path}: {error.strerror}: copy it again") from None
    warn_of_readers("users", path)
    if missing := {one.common_name for one in members} - users:
        raise SettingsError(f"{path} has no password of {min(missing)}: copy it again")
    if not users:
        raise SettingsError(f"{path} names nobody: copy it again")


def run(settings: Settings[HubSettings]) -> None:
    """Run the router until SIGTERM or SIGINT; raises SettingsError or InhandError."""
    stop = threading.Event()
    allow_many()
    with set_on_signals(stop):
        state, site = _state(settings), check(settings)
        while not stop.is_set():
            changed = _run_until_changed(settings, state, site, stop)
            if changed is None:
                return
            state, site = changed.state, changed.site


@dataclass(frozen=True)
class _Changed:
    state: State
    site: SiteMembers


def _run_until_changed(
    settings: Settings[HubSettings], state: State, site: SiteMembers, stop: threading.Event
) -> _Changed | None:
    """Run one router; return what is to run next, or None where a signal came."""
    others = [Site(site.realm, rig) for rig in site.rigs if rig != settings.site.rig]
    with running_daemon("hub", settings, _router(settings, site), also_in=others) as daemon:
        log.info(
            "%s of realm %s may connect to %s",
            counted(len(site.members_of(settings.instance)), "member"),
            site.realm,
            ", ".join(settings.service.listen),
        )
        daemon.health.state = "running"
        watch = _Watch(daemon, settings, state, site)
        members, linked = site.members_of(settings.instance), site.links_of(settings.instance)
        links = LinksWatch(daemon, {*(one.common_name for one in members), *linked})
        while not (daemon.stop.wait(DEFAULT_HUB.poll_s) or stop.is_set()):
            daemon.health.came_round()
            watch.look_at_ends()
            links.look()
            if (changed := watch.changed()) is not None:
                log.info("members or certificates changed: the hub starts anew, members return")
                return changed
    return None


class _Watch:
    """Looks whether files of the hub have changed, and whose certificate ends."""

    def __init__(
        self,
        daemon: Daemon,
        settings: Settings[HubSettings],
        state: State,
        site: SiteMembers,
        now: Callable[[], float] = time.monotonic,
    ) -> None:
        self._daemon = daemon
        self._settings = settings
        self._state = state
        self._refused: State | None = None
        self._site = site
        self._now = now
        self._next_look_at_ends = now()

    def changed(self) -> _Changed | None:
        """Return the files that are to be taken over; those that contradict each other are a
        trouble, and the hub goes on with what it has."""
        state = _state(self._settings)
        if state == self._state:
            self._daemon.health.well("files")
        if state in (self._state, self._refused):
            return None
        try:
            site = check(self._settings)
        except InhandError as error:
            self._daemon.health.trouble("files", f"goes on with former members: {error}")
            self._refused = state
            return None
        return _Changed(state, site)

    def look_at_ends(self) -> None:
        """Name those whose certificate ends soon, from time to time."""
        if self._now() < self._next_look_at_ends:
            return
        self._next_look_at_ends = self._now() + DEFAULT_HUB.warned_every_s
        ending = self._site.ending(DEFAULT_HUB.warned_days)
        for name, days in [*((member.place, days) for member, days in ending), *self._own_end()]:
            ends = f"ends in {counted(int(days), 'day')}" if days > 0.0 else "has ended"
            self._daemon.health.trouble(
                f"end {name}", f"the certificate of {name} {ends}: `inhand hub renew {name}`"
            )

    def _own_end(self) -> list[tuple[str, float]]:
        try:
            days = require_usable(_credentials(self._settings), serves=True)
        except InhandError:  # files that are being changed are looked at by ``changed``
            return []
        hub = self._site.hub(self._settings.instance)
        name = "hub" if hub is None else hub.name
        return [(name, days)] if days < DEFAULT_HUB.warned_days else []


@contextlib.contextmanager
def _router(settings: Settings[HubSettings], site: SiteMembers) -> Iterator[Session]:
    """Run the router of these members, which says so to each that may be what it is."""
    given = _credentials(settings)
    service, hub = settings.service, site.hub(settings.instance)
    rules = access_control(
        site.realm, site.members_of(settings.instance), site.links_of(settings.instance)
    )
    router = RouterSettings(
        service.listen,
        given.certificate,
        given.key,
        given.authority,
        rules,
        deliveries(site.realm, site.rigs),
        connect=service.connect,
        users=service.folder / USERS_FILE if hub is not None and hub.passwords else None,
    )
    with open_router(router) as session:
        patterns = [Site(site.realm, rig).access_pattern() for rig in site.rigs]
        handles = [answer(session, pattern, _agree) for pattern in patterns]
        yield session
        del handles


def _agree(_request: bytes) -> bytes:
    """Whoever the rules let ask is known to them."""
    return b""


def _credentials(settings: Settings[HubSettings]) -> Credentials:
    folder, key = settings.service.folder, settings.service.key
    return Credentials(folder / CERTIFICATE_FILE, key or folder / KEY_FILE, folder / AUTHORITY_FILE)


def _state(settings: Settings[HubSettings]) -> State:
    given = _credentials(settings)
    members = settings.service.folder / MEMBERS_FILE
    states: list[tuple[int, int, int] | None] = []
    users = settings.service.folder / USERS_FILE
    for path in (members, users, given.certificate, given.key, given.authority):
        try:
            status = path.stat()
        except OSError:
            states.append(None)
        else:
            states.append((status.st_ino, status.st_mtime_ns, status.st_size))
    return tuple(states)
