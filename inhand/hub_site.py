"""``inhand hub init | add | renew | revoke``: make a site's certificates, and say where they go."""

import argparse
import json
from collections.abc import Callable, Sequence
from pathlib import Path

from inhand_hub.access import ROLES, Member
from inhand_hub.members import (
    AUTHORITY_FILE,
    CERTIFICATE_FILE,
    KEY_FILE,
    MEMBERS_FILE,
    PASSWORD_FILE,
    SiteMembers,
)
from inhand_hub.settings import PORT
from inhand_hub.site_folder import HUB, SiteFolder, create_site
from inhand_runtime.errors import SettingsError
from inhand_runtime.exit_codes import DONE
from inhand_schemas.errors import KeyFormatError
from inhand_schemas.keys import require_name

HOSTS = ("localhost", "127.0.0.1")
FOLDER = Path("site")
TABLES = {
    "camera": '[capture.{name}]\nsource = "oak"',
    "tracker": '[tracker.{name}]\ncamera = "{camera}"\nmodels = {models}',
    "recorder": '[recorder.{name}]\nfolder = "recordings"',
    "studio": "[studio.{name}]",
    "outcomes": "[outcomes.{name}]",
    "viewer": "",
}
"""The table that a member's settings need of its own; names and objects are those of its rules."""


def administer(arguments: Sequence[str]) -> int:
    """Do what is asked of a site; raises SettingsError or InhandError."""
    chosen = _parser().parse_args(arguments)
    for what in ("realm", "name"):
        if (name := getattr(chosen, what, None)) is not None and chosen.action in ("init", "add"):
            _require_name(what, name)
    for name in (*getattr(chosen, "rigs", ()), *getattr(chosen, "objects", ())):
        _require_name("rig" if chosen.action == "init" else "object", name)
    return ACTIONS[chosen.action](chosen)


def _init(chosen: argparse.Namespace) -> int:
    folder = create_site(chosen.folder, chosen.realm, chosen.rigs, chosen.hosts)
    print(
        f"made {folder.path}. Keep {folder.path / 'authority'} to yourself, with a backup: whoever "
        "has it can let anybody in.\n\n"
        f"Copy {folder.hub} to the hub's host, and write into its settings, hub.toml:\n\n"
        f'realm = "{chosen.realm}"\nrig = "{chosen.rigs[0]}"\n\n'
        f'[hub.{HUB}]\nfolder = "{folder.hub}"\nlisten = ["{_listen(chosen.hosts)}"]\n\n'
        "Start it there: inhand hub --config hub.toml\n"
        f"Let somebody join: inhand hub add ROLE NAME --site {folder.path}"
    )
    return DONE


def _add(chosen: argparse.Namespace) -> int:
    folder = SiteFolder(chosen.site)
    site = folder.load()
    if chosen.role == HUB:
        return _add_hub(chosen, folder, site)
    if chosen.hosts or chosen.far or chosen.passwords:
        raise SettingsError(
            "--hosts, --far and --passwords are for `inhand hub add hub`: leave them out"
        )
    rig = chosen.rig or _only_rig(site)
    objects = tuple(dict.fromkeys(chosen.objects)) or (chosen.name,)
    if chosen.role != "tracker":
        if chosen.objects:
            raise SettingsError(f"a {chosen.role} publishes no poses: leave --objects out")
        objects = ()
    member = folder.add(chosen.role, chosen.name, rig, objects, by_password=chosen.password)
    site = folder.load()
    print(
        f"added {chosen.role} {member.place}. Copy {folder.folder_of(member)} to its host, for its "
        "user alone (chmod 700), and write into the settings beside it:\n\n"
        f"{_settings(site, member, folder)}\n\n{_hub_hears(folder)}"
    )
    return DONE


def _add_hub(chosen: argparse.Namespace, folder: SiteFolder, site: SiteMembers) -> int:
    if chosen.rig or chosen.objects or chosen.password:
        raise SettingsError(
            "a hub is of no rig and no object, and has a certificate: leave --rig, --objects and "
            "--password out"
        )
    hub = folder.add_hub(
        chosen.name, chosen.hosts or HOSTS, far=chosen.far, passwords=chosen.passwords
    )
    given = folder.folder_of_hub(hub.name)
    print(
        f"added hub {hub.name}. Copy {given} to its host, for its user alone (chmod 700), and "
        "write into the settings beside it:\n\n"
        f'realm = "{site.realm}"\nrig = "{site.rigs[0]}"\n\n'
        f'[hub.{hub.name}]\nfolder = "{given.name}"\nlisten = ["{_listen(hub.hosts)}"]\n'
        f'connect = ["{_reached(site.hosts)}"]\n\n{_hub_hears(folder)}'
    )
    return DONE


def _listen(hosts: Sequence[str]) -> str:
    return f"tls/{'127.0.0.1' if set(hosts) <= set(HOSTS) else '0.0.0.0'}:{PORT}"


def _reached(named: Sequence[str]) -> str:
    """The address at which others reach a hub of these hosts."""
    hosts = [host for host in named if host not in HOSTS] or ["127.0.0.1"]
    host = f"[{hosts[0]}]" if ":" in hosts[0] else hosts[0]
    return f"tls/{host}:{PORT}"


def _renew(chosen: argparse.Namespace) -> int:
    folder = SiteFolder(chosen.site)
    certificate = folder.renew(chosen.name)
    print(f"renewed: copy {certificate} over the former one on its host, and start anew there")
    if chosen.name != HUB:
        print(_hub_hears(folder))
    return DONE


def _revoke(chosen: argparse.Namespace) -> int:
    folder = SiteFolder(chosen.site)
    member = folder.revoke(chosen.name)
    who = f"{member.role} {member.place}" if isinstance(member, Member) else f"hub {member.name}"
    print(f"revoked {who}. {_hub_hears(folder)}")
    return DONE


def _hub_hears(folder: SiteFolder) -> str:
    return (
        f"A hub that runs with {folder.hub} itself sees it within a second and starts anew, which "
        "cuts everybody off for some seconds; to a hub on another host copy "
        f"{folder.hub / MEMBERS_FILE}, the same for all hubs of the site; one with passwords gets "
        "its users."
    )


def _settings(site: SiteMembers, member: Member, folder: SiteFolder) -> str:
    given = folder.folder_of(member).name
    hosts = site.hosts
    shown = f'certificate = "{given}/{CERTIFICATE_FILE}"\nkey = "{given}/{KEY_FILE}"\n'
    if member.by_password:
        hosts = next(one.hosts for one in site.hubs if one.passwords)
        shown = f'user = "{member.common_name}"\npassword = "{given}/{PASSWORD_FILE}"\n'
    models = json.dumps([f"{name}.model" for name in member.objects])
    cameras = (one.name for one in site.members if (one.role, one.rig) == ("camera", member.rig))
    table = TABLES[member.role].format(
        name=member.name, models=models, camera=next(cameras, "front")
    )
    return (
        f'realm = "{site.realm}"\nrig = "{member.rig}"\n\n'
        f'[zenoh]\nmode = "client"\nconnect = ["{_reached(hosts)}"]\n{shown}'
        f'authority = "{given}/{AUTHORITY_FILE}"\n\n{table}'
    ).rstrip()


def _only_rig(site: SiteMembers) -> str:
    if len(site.rigs) > 1:
        raise SettingsError(f"say which rig it is of: --rig {' or '.join(site.rigs)}")
    return site.rigs[0]


def _require_name(what: str, name: str) -> None:
    try:
        require_name(what, name)
    except KeyFormatError as error:
        raise SettingsError(str(error)) from None


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="inhand hub", description="Make who may join a site.")
    actions = parser.add_subparsers(dest="action", required=True)
    init = actions.add_parser("init", help="make a site: its authority, and the hub's certificate")
    init.add_argument("folder", type=Path, metavar="FOLDER", help="a folder that is not there yet")
    init.add_argument("--realm", required=True, help="the site: the first part of every key")
    init.add_argument("--rigs", required=True, nargs="+", metavar="RIG", help="its rigs")
    init.add_argument(
        "--hosts",
        nargs="+",
        default=list(HOSTS),
        metavar="HOST",
        help="names and addresses under which others reach the hub (default: this machine alone)",
    )
    add = actions.add_parser("add", help="let somebody join, and make its certificate")
    roles = (*ROLES, HUB)
    add.add_argument("role", choices=roles, metavar="ROLE", help=", ".join(roles))
    add.add_argument("name", metavar="NAME", help="the name of its instance, a camera's for one")
    add.add_argument("--rig", help="which rig it is of, where the site has several")
    add.add_argument(
        "--objects",
        nargs="+",
        default=(),
        metavar="OBJECT",
        help="whose poses a tracker publishes (default: the object of its name)",
    )
    add.add_argument(
        "--hosts",
        nargs="+",
        default=(),
        metavar="HOST",
        help="names and addresses under which others reach a further hub (default: its machine)",
    )
    add.add_argument(
        "--far", action="store_true", help="no full pictures pass between it and the first hub"
    )
    add.add_argument(
        "--passwords",
        action="store_true",
        help="it lets those in that have a password, and nobody by certificate",
    )
    add.add_argument(
        "--password",
        action="store_true",
        help="a member that joins by user and password, at a hub with passwords",
    )
    renew = actions.add_parser("renew", help="make a new certificate for a member, or a hub")
    revoke = actions.add_parser("revoke", help="let a member do nothing any more")
    for action in (renew, revoke):
        action.add_argument("name", metavar="NAME", help="its name, or RIG/NAME; renew also: hub")
    for action in (add, renew, revoke):
        action.add_argument(
            "--site", type=Path, default=FOLDER, metavar="FOLDER", help="the site (default: site)"
        )
    return parser


ACTIONS: dict[str, Callable[[argparse.Namespace], int]] = {
    "init": _init,
    "add": _add,
    "renew": _renew,
    "revoke": _revoke,
}
