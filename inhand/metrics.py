"""``inhand metrics``: give the health of a rig to Prometheus, on this machine alone, until Ctrl-C.

http://127.0.0.1:8731/metrics has it, of all instances that live and that the settings name.
"""

import argparse
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from wsgiref.types import StartResponse, WSGIApplication, WSGIEnvironment

from inhand_runtime.errors import SettingsError
from inhand_runtime.exit_codes import DONE
from inhand_runtime.roll import SILENT_AFTER_S, Roll
from inhand_runtime.service_manager import ServiceManager
from prometheus_client import CollectorRegistry, start_http_server

from inhand.health_metrics import HealthMetrics
from inhand.looking import open_look, positive_count
from inhand.status import expected_instances

ADDRESS = "127.0.0.1"
HOSTS = (ADDRESS, "localhost")
"""Names by which it can be asked."""
PORT = 8731
"""The port, where none is named: the next one to the studio's."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    parser.add_argument("--config", type=Path, metavar="FILE", help="the rig's settings (TOML)")
    parser.add_argument(
        "--port",
        type=positive_count,
        default=PORT,
        metavar="N",
        help=f"the port to listen at (default: {PORT})",
    )


def run(arguments: argparse.Namespace) -> int:
    """Answer until SIGTERM or Ctrl-C; raises SettingsError or InhandError."""
    expected = expected_instances(arguments.config)
    roll, manager = Roll(patience_s=SILENT_AFTER_S), ServiceManager()
    try:
        with open_look(arguments.config) as look:
            look.follow_tokens(roll.change)
            look.follow_health(roll.hear)
            with _served(HealthMetrics(roll, look.site, expected, look.can_hear), arguments.port):
                print(f"metrics: http://{ADDRESS}:{arguments.port}/metrics", flush=True)
                for _ in look.samples(None):
                    manager.advanced()
    except KeyboardInterrupt:
        manager.stopping()
    return DONE


def _for_this_machine(application: WSGIApplication) -> WSGIApplication:
    """Refuse requests for other hosts: a page of a site that lets its name point to this machine
    could read the answers."""

    def answer(environment: WSGIEnvironment, start: StartResponse) -> Iterable[bytes]:
        if str(environment.get("HTTP_HOST", ADDRESS)).partition(":")[0] in HOSTS:
            return application(environment, start)
        start("421 Misdirected Request", [("Content-Type", "text/plain")])
        return [f"ask by the name {' or '.join(HOSTS)}\n".encode()]

    return answer


@contextmanager
def _served(metrics: HealthMetrics, port: int) -> Iterator[None]:
    registry = CollectorRegistry()
    registry.register(metrics)
    try:
        server, thread = start_http_server(port, ADDRESS, registry)
    except (OSError, OverflowError) as error:
        raise SettingsError(
            f"cannot listen at port {port} ({error}): choose another by --port"
        ) from None
    if (application := server.get_app()) is not None:
        server.set_app(_for_this_machine(application))
    try:
        yield
    finally:
        server.shutdown()
        server.server_close()
        thread.join()
