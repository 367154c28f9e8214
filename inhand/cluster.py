"""The option that takes a verb's work to a cluster."""

import argparse
from pathlib import Path


def add_cluster_option(parser: argparse.ArgumentParser) -> None:
    """Add ``--cluster``."""
    parser.add_argument(
        "--cluster",
        metavar="tcp://HOST:PORT",
        help="work on the Dask cluster of this scheduler, whose workers see the same files",
    )


def work_path(arguments: argparse.Namespace, path: Path) -> Path:
    """Return a path as those who work on it know it: workers of a cluster have other folders."""
    return path.absolute() if arguments.cluster else path
