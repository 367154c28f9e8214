"""``inhand bench hub``: a site with a hub that runs, and the tables of what was measured at it."""

import os
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from inhand_hub.access import ROLES, RoleName
from inhand_hub.members import AUTHORITY_FILE, CERTIFICATE_FILE, KEY_FILE
from inhand_hub.site_folder import SiteFolder, create_site
from inhand_lab.benchmarks.hub_cost import HubCosts, Routers
from inhand_lab.benchmarks.hub_ends import RigEnds
from inhand_lab.demonstration.preparation import free_port
from inhand_runtime.errors import InhandError
from inhand_runtime.session import open_session
from inhand_runtime.settings import ZenohSettings
from inhand_runtime.supervisor_watch import supervised
from inhand_schemas.keys import Site
from rich.table import Table

REALM = "bench"
UP_S = 20.0
DELAYS = ("p50, ms", "p99, ms", "lost")
"""What is told of the delays of a stream."""


@contextmanager
def running_routers(folder: Path, count: int) -> Iterator[Routers]:
    """Run the hub of a site of some rigs, and that of a site of one, until the block ends."""
    with (
        _running_site(folder / "many", count) as (rigs, hub),
        _running_site(folder / "one", 1) as ((alone,), _),
    ):
        yield Routers(tuple(rigs), hub, alone, _plain_rig(alone))


@contextmanager
def _running_site(folder: Path, count: int) -> Iterator[tuple[list[RigEnds], int]]:
    rigs = _made_rigs(folder, count, f"tls/127.0.0.1:{free_port()}")
    with _running_hub(folder, rigs[0]) as hub:
        yield rigs, hub


def _made_rigs(folder: Path, count: int, address: str) -> list[RigEnds]:
    """Make a site of some rigs in a folder, each with a member of each role."""
    rigs = [f"rig_{number}" for number in range(count)]
    site = create_site(folder, REALM, rigs, ("127.0.0.1",))
    return [
        RigEnds(Site(REALM, rig), {role: _member(site, role, rig, address) for role in ROLES})
        for rig in rigs
    ]


def _member(site: SiteFolder, role: RoleName, rig: str, address: str) -> ZenohSettings:
    given = site.folder_of(site.add(role, role, rig, ("tracker",) if role == "tracker" else ()))
    return ZenohSettings(
        mode="client",
        connect=(address,),
        certificate=given / CERTIFICATE_FILE,
        key=given / KEY_FILE,
        authority=given / AUTHORITY_FILE,
    )


def _plain_rig(rig: RigEnds) -> RigEnds:
    """Return a rig as another one, at a router that encrypts nothing."""
    settings = ZenohSettings(mode="client", connect=(f"tcp/127.0.0.1:{free_port()}",))
    return RigEnds(rig.site, dict.fromkeys(rig.members, settings))


@contextmanager
def _running_hub(folder: Path, rig: RigEnds) -> Iterator[int]:
    """Run the hub of a site's folder until the block ends, and give its process; InhandError."""
    (address,) = rig.members["viewer"].connect
    config = folder / "hub.toml"
    config.write_text(
        f'realm = "{REALM}"\nrig = "{rig.site.rig}"\n[hub.hub]\nfolder = "hub"\n'
        f'listen = ["{address}"]\n',
        encoding="utf-8",
    )
    command = [sys.executable, "-m", "inhand", "hub", "--config", str(config)]
    with (folder / "hub.log").open("wb") as log:
        hub = subprocess.Popen(
            command, env={**os.environ, **supervised()}, stdin=subprocess.DEVNULL, stderr=log
        )
    try:
        _wait_until_up(rig.members["viewer"])
        yield hub.pid
    finally:
        hub.terminate()
        hub.wait()


def _wait_until_up(member: ZenohSettings) -> None:
    end = time.monotonic() + UP_S
    while True:
        try:
            with open_session(member):
                return
        except InhandError:
            if time.monotonic() > end:
                raise
            time.sleep(0.2)


def rigs_table(costs: HubCosts) -> Table:
    """A row for each number of rigs."""
    sizes = ", ".join(f"{name} {size / 1e3:,.1f} kB" for name, size in costs.message_bytes.items())
    table = Table(
        title="rigs on one hub, each with a camera, a tracker, a recorder and a viewer",
        caption=f"{sizes}; delays from put to callback in all rigs, in brackets those of the "
        "rigs with the smallest and the largest median",
    )
    table.add_column("rigs")
    for name in (
        "frames/s each",
        "cores a rig",
        "hub, MB",
        "machine busy",
        *(f"{name}, {what}" for name in ("frame", "pose") for what in DELAYS),
    ):
        table.add_column(name, justify="right")
    for one in costs.rigs:
        cells = []
        for delay in one.delays.values():
            cells += [
                f"{delay.p50_ms:.1f} ({delay.lowest_p50_ms:.1f} to {delay.highest_p50_ms:.1f})",
                f"{delay.p99_ms:.1f}",
                f"{delay.lost:.1%}",
            ]
        table.add_row(
            f"{one.rigs}, one with a stuck reader" if one.stuck else f"{one.rigs}",
            f"{one.frame_rate:.1f}",
            f"{one.hub_cores / one.rigs:.3f}",
            f"{one.hub_mb:.0f}",
            f"{one.busy:.0%}",
            *cells,
        )
    return table


def security_table(costs: HubCosts) -> Table:
    """A row for each stream."""
    table = Table(title="TLS and access rules, beside a plain router in turns, p50")
    table.add_column("stream")
    table.add_column("rigs of the site", justify="right")
    for name in ("hub, ms", "plain, ms", "times", "in pairs"):
        table.add_column(name, justify="right")
    for one in costs.security:
        table.add_row(
            one.stream,
            f"{one.rigs}",
            f"{one.hub_ms:.2f}",
            f"{one.plain_ms:.2f}",
            f"{one.ratio:.2f}",
            f"{min(one.ratios):.2f} to {max(one.ratios):.2f}",
        )
    return table
