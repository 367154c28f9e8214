"""What verbs share that ask instances which run: ``inhand recorder pause`` and its like."""

import argparse
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol, TypeVar

import msgspec
from inhand_runtime.exit_codes import DONE, FAILED
from inhand_runtime.wording import printable
from inhand_schemas.keys import Site
from inhand_schemas.procedure import Procedure

from inhand.looking import UNREACHED, add_looking_arguments, nothing_heard, open_look
from inhand.results import write_json

Q = TypeVar("Q", bound=msgspec.Struct)
R = TypeVar("R", bound=msgspec.Struct)

SECONDS = 3.0
"""How long instances are waited for unless somebody says otherwise."""


class Doubtful(Protocol):
    """A reply that may say what is wrong."""

    @property
    def problem(self) -> str | None:
        """What is wrong; None where nothing is."""


def asking_parser(
    verb: str, whom: str, helps: Mapping[str, str], *, named: str
) -> argparse.ArgumentParser:
    """The parser of ``inhand VERB`` with the words that instances take, by their helps."""
    parser = argparse.ArgumentParser(prog=f"inhand {verb}", description=f"Ask running {whom}.")
    verbs = parser.add_subparsers(dest="verb", required=True)
    for word, text in helps.items():
        one = verbs.add_parser(word, help=text, description=f"{text[0].upper()}{text[1:]}.")
        one.add_argument("--name", help=f"of this {named} only (default: of all)")
        add_looking_arguments(one, SECONDS, f"to wait for {whom} to answer")
        one.add_argument("--json", type=Path, metavar="FILE", help="write the replies there")
    return parser


def ask_instances(
    procedure: Procedure[Q, R],
    request: Q,
    expected: Collection[str],
    config: Path | None,
    seconds: float,
) -> tuple[Site, dict[str, R]]:
    """Ask all instances that are meant, until those ``expected`` have answered; their rig, and the
    replies by name in its order.

    Raises SettingsError, and InhandError where nobody answers and nobody is expected.
    """

    def name_of(reply: R) -> str:
        return str(getattr(reply, procedure.named))

    def complete(replies: list[R]) -> bool:
        return bool(expected) and set(map(name_of, replies)).issuperset(expected)

    with open_look(config) as look:
        answers = look.ask(procedure, request, complete, seconds)
        if not answers and not expected:
            raise nothing_heard(look.site, seconds)
        return look.site, {name_of(reply): reply for reply in sorted(answers, key=name_of)}


def conclude(
    replies: Mapping[str, Doubtful], expected: Sequence[str], key: str, path: Path | None
) -> int:
    """Print what is wrong, write all to a file where one is named, and return the exit code."""
    problems = [
        *(f"{name}: {reply.problem}" for name, reply in replies.items() if reply.problem),
        *(f"{name} does not answer: {UNREACHED}" for name in expected if name not in replies),
    ]
    for line in problems:
        print(f"WRONG: {printable(line)}")
    if path is not None:
        rows: list[Any] = [msgspec.to_builtins(reply) for reply in replies.values()]
        write_json(path, {key: rows, "problems": problems})
    return FAILED if problems else DONE
