"""The folder of a site: its authority, and what its hub and each member are given.

``authority`` stays with who administers the site, ``hub`` goes to the hub, ``members/RIG.NAME`` to
that member, ``hubs/NAME`` to a further hub. What counts is the hub's list of members: it is written
last where somebody joins, and first where somebody leaves, each time whole, so that a crash leaves
the site as it was before, or as it is after. What it left old in the folders of further hubs is put
right by whatever is done to the site next.
"""

import contextlib
import ipaddress
import logging
import re
import secrets
import shutil
from collections.abc import Iterator, Sequence
from pathlib import Path

from inhand_runtime.errors import InhandError, SettingsError
from inhand_runtime.locked_folder import locked_folder
from inhand_runtime.private_file import new_private_file, sync_folder
from msgspec.structs import replace

from inhand_hub.access import LinkedHub, Member, RoleName
from inhand_hub.certificates import (
    Issued,
    PrivateKey,
    hub_certificate,
    key_pem,
    load_issued,
    load_key,
    member_certificate,
    new_authority,
    new_key,
)
from inhand_hub.members import (
    AUTHORITY_FILE,
    CERTIFICATE_FILE,
    KEY_FILE,
    LONGEST_COMMON_NAME,
    MEMBERS_FILE,
    PASSWORD_FILE,
    USERS_FILE,
    SiteMembers,
    encode_members,
    load_members,
    with_hub,
    with_member,
    without_hub,
    without_member,
)
from inhand_hub.parameters import DEFAULT_HUB

log = logging.getLogger(__name__)

HUB = "hub"
"""The hub's folder, and the name that is therefore no member's."""
PRIVATE_FOLDER = 0o700
PASSWORD_BYTES = 24
"""Random bytes of a password."""

_HOST_NAME = re.compile(r"(?!-)[a-z0-9-]{1,63}(?<!-)(\.(?!-)[a-z0-9-]{1,63}(?<!-))*", re.IGNORECASE)


class SiteFolder:
    """The folder of a site, as ``create_site`` makes it.

    What is done to it raises SettingsError, or InhandError where it cannot be written.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.hub = path / HUB

    def load(self) -> SiteMembers:
        """Read who belongs to the site."""
        return load_members(self.hub / MEMBERS_FILE)

    def folder_of(self, member: Member) -> Path:
        """Return the folder of what a member is given."""
        return self.path / "members" / f"{member.rig}.{member.name}"

    def add(
        self,
        role: RoleName,
        name: str,
        rig: str,
        objects: Sequence[str],
        *,
        by_password: bool = False,
    ) -> Member:
        """Let somebody join; raises SettingsError for a name or an object that another has."""
        with self._locked():
            site = self.load()
            member = _new_member(site, role, name, rig, objects)
            if by_password:
                if not any(one.passwords for one in site.hubs):
                    raise SettingsError(
                        "no hub of the site takes passwords: make one by `inhand hub add hub NAME "
                        "--passwords`"
                    )
                member = replace(member, by_password=True)
                with _new_folder(self.folder_of(member), replace=True) as unfinished:
                    _write_password(unfinished)
                    _write_file(unfinished / AUTHORITY_FILE, self._authority_pem())
                self._write(with_member(site, member, None))
                return member
            key = new_key()
            issued = member_certificate(self._authority(), member.common_name, key)
            folder = self.folder_of(member)
            with _new_folder(folder, replace=True) as unfinished:
                _write_given(unfinished, issued, self._authority_pem())
            self._write(with_member(site, member, issued.ends_at))
        return member

    def folder_of_hub(self, name: str) -> Path:
        """Return the folder of what a further hub is given."""
        return self.path / "hubs" / name

    def add_hub(
        self, name: str, hosts: Sequence[str], *, far: bool = False, passwords: bool = False
    ) -> LinkedHub:
        """Let a further hub join, which connects to the first; raises SettingsError."""
        for host in hosts:
            _require_host(host)
        with self._locked():
            site = self.load()
            taken = {HUB, *(one.name for one in site.hubs), *(one.name for one in site.members)}
            if name in taken:
                raise SettingsError(f"{name} is there already: choose another name")
            suffix = secrets.token_hex(DEFAULT_HUB.suffix_bytes)
            common_name = _short(f"hub.{name}.{suffix}", name)
            issued = self._linked_certificate(common_name, new_key(), hosts)
            linked = LinkedHub(
                name=name,
                common_name=common_name,
                hosts=tuple(hosts),
                ends_at=issued.ends_at,
                far=far,
                passwords=passwords,
            )
            folder = self.folder_of_hub(name)
            folder.parent.mkdir(mode=PRIVATE_FOLDER, exist_ok=True)
            with _new_folder(folder, replace=True) as unfinished:
                _write_given(unfinished, issued, self._authority_pem())
            self._write(with_hub(site, linked))
        return linked

    def renew(self, text: str) -> Path:
        """Give a member, or a hub, a new certificate for its key, or a new password; return its
        file."""
        with self._locked():
            site = self.load()
            if text == HUB:
                key = load_key((self.hub / KEY_FILE).read_bytes())
                issued = hub_certificate(self._authority(), site.hub_name, key, site.hosts)
                _write_file(self.hub / CERTIFICATE_FILE, issued.certificate)
                return self.hub / CERTIFICATE_FILE
            if (linked := site.hub(text)) is not None:
                folder = self.folder_of_hub(linked.name)
                key = load_key((folder / KEY_FILE).read_bytes())
                issued = self._linked_certificate(linked.common_name, key, linked.hosts)
                _write_file(folder / CERTIFICATE_FILE, issued.certificate)
                self._write(with_hub(site, replace(linked, ends_at=issued.ends_at)))
                return folder / CERTIFICATE_FILE
            member = site.find(text)
            folder = self.folder_of(member)
            if member.by_password:
                _write_password(folder)
                self._write(site)
                return folder / PASSWORD_FILE
            key = load_key((folder / KEY_FILE).read_bytes())
            issued = member_certificate(self._authority(), member.common_name, key)
            _write_file(folder / CERTIFICATE_FILE, issued.certificate)
            self._write(with_member(site, member, issued.ends_at))
            return folder / CERTIFICATE_FILE

    def revoke(self, text: str) -> Member | LinkedHub:
        """Let a member, or a further hub, do nothing any more; what it was given goes from here."""
        with self._locked():
            site = self.load()
            if (linked := site.hub(text)) is not None:
                self._write(without_hub(site, linked))
                shutil.rmtree(self.folder_of_hub(linked.name), ignore_errors=True)
                return linked
            member = site.find(text)
            self._write(without_member(site, member))
            shutil.rmtree(self.folder_of(member), ignore_errors=True)
        return member

    def _write(self, site: SiteMembers) -> None:
        """Write the list of members, for the first hub before all others."""
        for hub in site.hubs:
            if hub.passwords:
                self._write_users(hub, self._users(site))
        for folder in (self.hub, *(self.folder_of_hub(one.name) for one in site.hubs)):
            _write_file(folder / MEMBERS_FILE, encode_members(site))

    def _put_right(self) -> None:
        """Write what a crash left old: lists of members and users that are not the first hub's."""
        site = self.load()
        members = (self.hub / MEMBERS_FILE).read_bytes()
        for hub in site.hubs:
            folder = self.folder_of_hub(hub.name)
            if not folder.is_dir():  # somebody keeps it elsewhere
                continue
            old = []
            if hub.passwords and _lines(folder / USERS_FILE)[1:] != self._users(site):
                self._write_users(hub, self._users(site))
                old.append(USERS_FILE)
            if _lines(folder / MEMBERS_FILE) != members.splitlines():
                _write_file(folder / MEMBERS_FILE, members)
                old.append(MEMBERS_FILE)
            if old:
                log.warning(
                    "%s of hub %s was old, as after a crash, and is put right: copy it to its host",
                    " and ".join(old),
                    hub.name,
                )

    def _users(self, site: SiteMembers) -> list[bytes]:
        """Return names and passwords as Zenoh reads them, a line each."""
        users = []
        for one in site.members:
            if one.by_password:
                password = (self.folder_of(one) / PASSWORD_FILE).read_text().strip()
                users.append(f"{one.common_name}:{password}".encode())
        return users

    def _write_users(self, hub: LinkedHub, users: Sequence[bytes]) -> None:
        """Write who has a password, with a first one that nobody has: where there is none, Zenoh
        asks for none."""
        nobody = f"nobody:{secrets.token_urlsafe(PASSWORD_BYTES)}".encode()
        lines = b"".join(line + b"\n" for line in (nobody, *users))
        _write_file(self.folder_of_hub(hub.name) / USERS_FILE, lines)

    def _linked_certificate(
        self, common_name: str, key: PrivateKey, hosts: Sequence[str]
    ) -> Issued:
        return hub_certificate(self._authority(), common_name, key, hosts, connects=True)

    def _authority_pem(self) -> bytes:
        return (self.path / "authority" / CERTIFICATE_FILE).read_bytes()

    def _authority(self) -> Issued:
        folder = self.path / "authority"
        try:
            return load_issued(self._authority_pem(), (folder / KEY_FILE).read_bytes())
        except ValueError as error:
            raise SettingsError(f"{folder}: {error}: get it back from a backup") from None

    @contextlib.contextmanager
    def _locked(self) -> Iterator[None]:
        try:
            with locked_folder(self.path):
                self._put_right()
                yield
        except ValueError as error:
            raise SettingsError(f"{self.path}: {error}: get it back from a backup") from None
        except OSError as error:
            raise _failure(error, self.path) from None


def create_site(path: Path, realm: str, rigs: Sequence[str], hosts: Sequence[str]) -> SiteFolder:
    """Make a site without members; raises SettingsError where there is something already."""
    for host in hosts:
        _require_host(host)
    site = SiteMembers(realm=realm, rigs=tuple(dict.fromkeys(rigs)), hosts=tuple(hosts))
    authority = new_authority(f"Inhand authority of {realm}"[:LONGEST_COMMON_NAME])
    hub = hub_certificate(authority, site.hub_name, new_key(), hosts)
    try:
        path.absolute().parent.mkdir(parents=True, exist_ok=True)
        with locked_folder(path.absolute().parent), _new_folder(path, replace=False) as unfinished:
            for folder in ("authority", HUB, "members"):
                (unfinished / folder).mkdir(mode=PRIVATE_FOLDER)
            _write_file(unfinished / "authority" / KEY_FILE, key_pem(authority.key))
            _write_file(unfinished / "authority" / CERTIFICATE_FILE, authority.certificate)
            _write_given(unfinished / HUB, hub, authority.certificate)
            _write_file(unfinished / HUB / MEMBERS_FILE, encode_members(site))
    except OSError as error:
        raise _failure(error, path) from None
    return SiteFolder(path)


def _new_member(
    site: SiteMembers, role: RoleName, name: str, rig: str, objects: Sequence[str]
) -> Member:
    if rig not in site.rigs:
        raise SettingsError(f"the site has no rig {rig!r} (there are: {', '.join(site.rigs)})")
    if name == HUB:
        raise SettingsError("the name hub is the hub's own: choose another one")
    suffix = secrets.token_hex(DEFAULT_HUB.suffix_bytes)
    common_name = _short(f"{rig}.{name}.{suffix}", f"{rig}/{name}")
    if site.hub(name) is not None:
        raise SettingsError(f"a hub is named {name} already: choose another name")
    member = Member(name=name, rig=rig, role=role, common_name=common_name, objects=tuple(objects))
    for other in site.members:
        if other.place == member.place:
            raise SettingsError(
                f"{member.place} is a {other.role} already: choose another name, or revoke it first"
            )
        if other.rig == rig and (shared := set(other.objects) & set(objects)):
            raise SettingsError(
                f"{other.place} publishes the pose of {min(shared)} already: each object has one "
                "tracker in a rig"
            )
    return member


def _short(common_name: str, name: str) -> str:
    if len(common_name) > LONGEST_COMMON_NAME:
        raise SettingsError(f"{name} is too long for a certificate: choose a shorter name")
    return common_name


def _require_host(host: str) -> None:
    with contextlib.suppress(ValueError):
        ipaddress.ip_address(host)
        return
    if not _HOST_NAME.fullmatch(host) or len(host) > 253:
        raise SettingsError(f"{host!r} is no host: write a name such as hub.local, or an address")


def _write_password(folder: Path) -> None:
    _write_file(folder / PASSWORD_FILE, f"{secrets.token_urlsafe(PASSWORD_BYTES)}\n".encode())


def _write_given(folder: Path, issued: Issued, authority: bytes) -> None:
    """Write what the hub or a member needs: its certificate and key, and whom it trusts."""
    _write_file(folder / KEY_FILE, key_pem(issued.key))
    _write_file(folder / CERTIFICATE_FILE, issued.certificate)
    _write_file(folder / AUTHORITY_FILE, authority)


@contextlib.contextmanager
def _new_folder(path: Path, *, replace: bool) -> Iterator[Path]:
    """Fill a folder, which gets its name when it is whole; what is left of an earlier try goes.

    ``replace`` takes the place of a folder that counts no more; else raises SettingsError for it.
    """
    if not replace and (path.is_symlink() or path.exists()):
        raise SettingsError(f"{path} is there already, and stays: choose another folder")
    unfinished = path.absolute().with_name(f".{path.name}.unfinished")
    if unfinished.exists():
        shutil.rmtree(unfinished)
    unfinished.mkdir(mode=PRIVATE_FOLDER)
    try:
        yield unfinished
        if replace and path.exists():
            shutil.rmtree(path)
        unfinished.rename(path)
        sync_folder(path.absolute().parent)
    finally:
        shutil.rmtree(unfinished, ignore_errors=True)


def _lines(path: Path) -> list[bytes]:
    return path.read_bytes().splitlines() if path.exists() else []


def _write_file(path: Path, data: bytes) -> None:
    """Write a file that only its owner reads, whole or not at all."""
    with new_private_file(path) as file:
        file.write(data)


def _failure(error: OSError, path: Path) -> InhandError:
    if isinstance(error, FileNotFoundError):
        return SettingsError(
            f"{error.filename or path} is not there: name the folder that `inhand hub init` made"
        )
    return InhandError(f"cannot write {error.filename or path}: {error.strerror or error}")
