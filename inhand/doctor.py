"""``inhand doctor``: look at this host and a rig's settings, and say what must be mended.

Exit code 1 when anything must be. It starts nothing, and opens no camera.
"""

import argparse
import subprocess
import sys
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

from inhand_capture.shutter import ShutterFile
from inhand_runtime.exit_codes import DONE, FAILED
from inhand_runtime.settings import SERVICES, RigFile, load_rig_file
from inhand_schemas.keys import Site

from inhand.camera_findings import oak_findings, rule_finding, usb_cameras, usb_findings
from inhand.findings import (
    Finding,
    clock_finding,
    disk_finding,
    hub_findings,
    memory_finding,
    version_finding,
)
from inhand.results import write_json


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    parser.add_argument("--config", type=Path, metavar="FILE", help="the rig's settings (TOML)")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the findings there")


def run(arguments: argparse.Namespace) -> int:
    """Print every finding as it comes, what must be mended last; SettingsError for a file that is
    none."""
    rig_file = load_rig_file(arguments.config)
    findings = []
    for finding in all_findings(rig_file, arguments.config):
        findings.append(finding)
        if finding.mend is None:
            print(f"ok     {finding.what}", flush=True)
    wrong = [finding for finding in findings if finding.mend is not None]
    for finding in wrong:
        print(f"WRONG  {finding.what}: {finding.mend}")
    if arguments.json is not None:
        write_json(
            arguments.json,
            {"findings": [{"what": one.what, "mend": one.mend} for one in findings]},
        )
    return FAILED if wrong else DONE


def all_findings(rig_file: RigFile, config: Path | None) -> Iterator[Finding]:
    """Look at everything, in the order in which it is needed."""
    yield version_finding()
    yield clock_finding(shared=bool(rig_file.zenoh.connect or rig_file.zenoh.listen))
    yield memory_finding({service: len(getattr(rig_file, service)) for service in SERVICES})
    yield from settings_findings(rig_file, config)
    for recorder in rig_file.recorder.values():
        folder = recorder.get("folder", "recordings")
        if isinstance(folder, str):  # of anything else the line that it cannot start speaks
            yield disk_finding((Path() if config is None else config.parent) / folder)
    oaks = {
        name: options
        for name, table in rig_file.capture.items()
        if table.get("source") == "oak" and isinstance(options := table.get("options", {}), dict)
    }
    cameras = usb_cameras()
    yield from usb_findings(cameras)
    if cameras or any("ip" not in options for options in oaks.values()):
        yield rule_finding()
    if oaks and find_spec("depthai") is not None:  # without it, "cannot start" says so
        yield from oak_findings(oaks)
    yield from shutter_findings(rig_file)
    yield from hub_findings(rig_file.zenoh)


def settings_findings(rig_file: RigFile, config: Path | None) -> Iterator[Finding]:
    """What each process of the settings says before its start: extras, weights, models, folders."""
    file = [] if config is None else ["--config", str(config)]
    for service in SERVICES:
        for instance in getattr(rig_file, service):
            command = [sys.executable, "-m", "inhand", service, *file, "--name", instance]
            checked = subprocess.run(
                [*command, "--check-config"],
                stdin=subprocess.DEVNULL,
                capture_output=True,
                text=True,
                check=False,
            )
            if checked.returncode == DONE:
                yield Finding(f"{service} {instance}: its settings are valid, and it can start")
            else:
                lines = checked.stderr.strip().splitlines() or ["it did not say why"]
                yield Finding(f"{service} {instance} cannot start", lines[-1])


def shutter_findings(rig_file: RigFile) -> Iterator[Finding]:
    """Which cameras of this host have their shutter closed, which is no fault."""
    site = Site(rig_file.realm, rig_file.rig)
    for camera in rig_file.capture:
        if ShutterFile(site, camera).is_closed():
            yield Finding(f"shutter of {camera}: closed; `inhand shutter open` opens it")
