"""``inhand hub``: the router of a site, and (``init``, ``add``, …) who may join it."""

import sys
from collections.abc import Sequence

from inhand_hub.service import check, run
from inhand_hub.settings import HubSettings
from inhand_runtime.entry import daemon_main

ACTIONS = ("init", "add", "renew", "revoke")
HELP = "Who may join a site is made by: inhand hub init | add | renew | revoke (--help for each).\n"


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the daemon until a signal, or do what is asked of a site; returns the exit code."""
    arguments = sys.argv[1:] if arguments is None else arguments
    if arguments and arguments[0] in ACTIONS:
        from inhand.hub_site import administer  # needs the extra hub, and the daemon does not

        return administer(arguments)
    if arguments and arguments[0] in ("-h", "--help"):
        print(HELP)
    return daemon_main("hub", HubSettings, run, arguments, check=check)
