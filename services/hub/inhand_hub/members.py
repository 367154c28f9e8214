"""Who belongs to a site: the list that ``inhand hub add`` writes and the hub reads."""

import os
import time
from collections.abc import Iterable
from pathlib import Path
from typing import Annotated

import msgspec
from inhand_runtime.errors import SettingsError
from inhand_runtime.hub_access import DAY_S
from inhand_schemas.fields import Name, Text
from msgspec import Meta, Struct

from inhand_hub.access import LinkedHub, Member, Rule, link_rules

LONGEST_COMMON_NAME = 64
"""Characters that X.509 allows."""
MEMBERS_FILE = "members.json"
USERS_FILE, PASSWORD_FILE = "users", "password"
"""The names and passwords that a hub with passwords takes, and what such a member is given."""
AUTHORITY_FILE, CERTIFICATE_FILE, KEY_FILE = "authority.pem", "certificate.pem", "key.pem"
"""What the hub, and each member, has beside: whom it trusts, and what it shows."""


class SiteMembers(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A site: its realm, its rigs, under which hosts its hub is reached, and its members.

    ``ends_at`` is when each certificate ends, by common name, in seconds since the epoch; ``hubs``
    are those beside the first. A later release's list may have fields that take rights away, so
    that one with fields unknown here is refused.
    """

    realm: Name
    rigs: Annotated[tuple[Name, ...], Meta(min_length=1)]
    hosts: tuple[Text, ...]
    members: tuple[Member, ...] = ()
    ends_at: dict[Text, float] = {}
    hubs: tuple[LinkedHub, ...] = ()

    @property
    def hub_name(self) -> str:
        """The common name of the first hub's certificate."""
        return f"Inhand hub of {self.realm}"[:LONGEST_COMMON_NAME]

    def hub(self, name: str) -> LinkedHub | None:
        """Return the further hub of that name, if there is one."""
        return next((one for one in self.hubs if one.name == name), None)

    def members_of(self, name: str) -> tuple[Member, ...]:
        """Return the members that a hub lets in."""
        hub = self.hub(name)
        passwords = hub is not None and hub.passwords
        return tuple(one for one in self.members if one.by_password == passwords)

    def links_of(self, name: str) -> dict[str, tuple[Rule, ...]]:
        """Return the rules of the hubs that a hub may be linked with, by their common names: those
        of all others for the first hub, of the first for the others."""
        if (own := self.hub(name)) is not None:
            return {self.hub_name: link_rules(self.realm, self.rigs, far=own.far)}
        return {
            one.common_name: link_rules(self.realm, self.rigs, far=one.far) for one in self.hubs
        }

    def find(self, text: str) -> Member:
        """Return the member that ``RIG/NAME`` means, or ``NAME`` where only one rig has it."""
        found = [one for one in self.members if text in (one.name, one.place)]
        if len(found) == 1:
            return found[0]
        if found:
            places = " or ".join(one.place for one in found)
            raise SettingsError(f"several members are named {text!r}: say {places}")
        there = ", ".join(one.place for one in self.members) or "none yet"
        raise SettingsError(f"there is no member {text!r} (there are: {there})")

    def ending(self, within_days: float) -> list[tuple[Member, float]]:
        """Return the members whose certificate ends within some days, with the days that remain."""
        now = time.time()
        ends = ((one, self.ends_at.get(one.common_name)) for one in self.members)
        days = [(one, (end - now) / DAY_S) for one, end in ends if end is not None]
        return [(member, left) for member, left in days if left < within_days]


def with_member(site: SiteMembers, member: Member, ends_at: float | None) -> SiteMembers:
    """Return the site with a member added, or in the place of the one with its common name; its
    certificate, if it has one, ends at a time."""
    others = tuple(one for one in site.members if one.common_name != member.common_name)
    return msgspec.structs.replace(
        site,
        members=(*others, member),
        ends_at=site.ends_at if ends_at is None else {**site.ends_at, member.common_name: ends_at},
    )


def without_member(site: SiteMembers, member: Member) -> SiteMembers:
    """Return the site without a member."""
    return msgspec.structs.replace(
        site,
        members=tuple(one for one in site.members if one != member),
        ends_at={name: at for name, at in site.ends_at.items() if name != member.common_name},
    )


def with_hub(site: SiteMembers, hub: LinkedHub) -> SiteMembers:
    """Return the site with a further hub, or in the place of the one with its common name."""
    others = tuple(one for one in site.hubs if one.common_name != hub.common_name)
    return msgspec.structs.replace(site, hubs=(*others, hub))


def without_hub(site: SiteMembers, hub: LinkedHub) -> SiteMembers:
    """Return the site without one of its further hubs."""
    return msgspec.structs.replace(site, hubs=tuple(one for one in site.hubs if one != hub))


def encode_members(site: SiteMembers) -> bytes:
    """Return the list as its file holds it: JSON, a line a value."""
    return msgspec.json.format(msgspec.json.encode(site)) + b"\n"


def load_members(path: Path) -> SiteMembers:
    """Read the list; raises SettingsError for one that is none, or contradicts itself."""
    try:
        site = msgspec.json.decode(path.read_bytes(), type=SiteMembers)
    except PermissionError as error:
        raise SettingsError(
            f"cannot read {path}: {error.strerror}: the folder has to belong to the user who runs "
            f"the hub: chown -R {os.geteuid()} {path.parent}"
        ) from None
    except OSError as error:
        raise SettingsError(
            f"cannot read {path}: {error.strerror}: make a site by `inhand hub init`, or copy its "
            "hub folder"
        ) from None
    except (msgspec.MsgspecError, UnicodeDecodeError) as error:
        raise SettingsError(
            f"{path} is no list of members that this release reads: {error}; copy it again, or "
            "update this host"
        ) from None
    if problem := _contradiction(site):
        raise SettingsError(f"{path}: {problem}; copy it again")
    return site


def _contradiction(site: SiteMembers) -> str | None:
    common_names = [one.common_name for one in site.members]
    if twice := _repeated([*common_names, *(one.common_name for one in site.hubs)]):
        return f"{twice!r} stands there twice"
    if twice := _repeated(one.place for one in site.members):
        return f"{twice!r} stands there twice"
    if twice := _repeated(site.rigs) or _repeated(one.name for one in site.hubs):
        return f"{twice!r} stands there twice"
    certified = {one.common_name for one in site.members if not one.by_password}
    if set(site.ends_at) != certified:
        return "members and ends of their certificates do not fit"
    if strangers := {one.rig for one in site.members} - set(site.rigs):
        return f"{min(strangers)!r} is no rig of the site"
    return None


def _repeated(names: Iterable[str]) -> str | None:
    seen: set[str] = set()
    for name in names:
        if name in seen:
            return name
        seen.add(name)
    return None
