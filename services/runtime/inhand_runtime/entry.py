"""The command line that all daemons share: ``python -m SERVICE [--config F] [--name N]``."""

import argparse
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TypeVar

from inhand_runtime.errors import InhandError, SettingsError
from inhand_runtime.exit_codes import DONE, FAILED, WRONG_USAGE
from inhand_runtime.extras import missing_extra
from inhand_runtime.hub_access import require_client
from inhand_runtime.settings import Section, Settings, load_settings
from inhand_runtime.supervisor_watch import end_with_supervisor

S = TypeVar("S", bound=Section)


def daemon_main(
    service: str,
    model: type[S],
    run: Callable[[Settings[S]], None],
    arguments: Sequence[str] | None = None,
    *,
    check: Callable[[Settings[S]], object] | None = None,
    instead: Mapping[str, tuple[str, Callable[[], int]]] | None = None,
    folders: Mapping[str, str] | None = None,
    epilog: str | None = None,
) -> int:
    """Run one daemon until it ends; returns its exit code, after one line about what failed.

    ``arguments`` are the process's own unless given. ``check`` is what ``run`` does first as well:
    it raises SettingsError for all that can be known before a start. ``instead`` are options that
    do something else and end: by their name what the help says, and what returns the exit code.
    ``folders`` are settings that the command line may have in place of the file's, with their help,
    and ``epilog`` is what the help says at its end.
    Wrong arguments end the process with 2. It ends when a supervisor that started it is gone.
    """
    end_with_supervisor()
    instead, folders = instead or {}, folders or {}
    parser = _parser(service, {name: text for name, (text, _) in instead.items()}, folders, epilog)
    chosen = parser.parse_args(arguments)
    try:
        for name, (_, act) in instead.items():
            if getattr(chosen, name):
                return act()
        given = {
            name: str(folder.absolute())
            for name in folders
            if (folder := getattr(chosen, name)) is not None
        }
        settings = load_settings(chosen.config, service, model, chosen.name, given)
        if chosen.check_config:
            require_client(settings.zenoh)
            if check is not None:
                check(settings)
            print(f"{service} {settings.instance}: the settings are valid")
        else:
            run(settings)
    except InhandError as error:
        print(f"{service}: {error}", file=sys.stderr)
        return WRONG_USAGE if isinstance(error, SettingsError) else FAILED
    except ModuleNotFoundError as error:
        if (needs := missing_extra(error)) is None:
            raise
        print(f"{service}: {needs}", file=sys.stderr)
        return WRONG_USAGE
    return DONE


def _parser(
    service: str, instead: Mapping[str, str], folders: Mapping[str, str], epilog: str | None
) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog=f"inhand {service}",
        description=f"Run one {service} daemon until SIGTERM or Ctrl-C.",
        epilog=epilog,
    )
    parser.add_argument("--config", type=Path, metavar="FILE", help="the rig's settings (TOML)")
    parser.add_argument("--name", help="which instance of the file, where it names several")
    parser.add_argument(
        "--check-config", action="store_true", help="check the settings and start nothing"
    )
    for name, text in instead.items():
        parser.add_argument(f"--{name}", action="store_true", help=text)
    for name, text in folders.items():
        parser.add_argument(f"--{name}", type=Path, metavar="FOLDER", help=text)
    return parser
