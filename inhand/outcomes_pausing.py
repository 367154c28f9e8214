"""``inhand outcomes pause`` and ``resume``: words to daemons of outcomes that run."""

import argparse
from collections.abc import Sequence
from pathlib import Path

import msgspec
from inhand_runtime.exit_codes import DONE, FAILED
from inhand_runtime.settings import load_rig_file
from inhand_runtime.writable import require_writable_file
from inhand_schemas.procedures import (
    PAUSE_MEASURING,
    RESUME_MEASURING,
    OutcomesReply,
    OutcomesRequest,
)

from inhand.looking import (
    UNREACHED,
    add_looking_arguments,
    expected_instances,
    nothing_heard,
    open_look,
)
from inhand.outcomes_words import ASKED
from inhand.results import write_json

SECONDS = 3.0
_PROCEDURES = {one.verb: one for one in (PAUSE_MEASURING, RESUME_MEASURING)}


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="inhand outcomes", description="Ask running daemons.")
    verbs = parser.add_subparsers(dest="verb", required=True)
    for verb, text in ASKED.items():
        one = verbs.add_parser(verb, help=text, description=f"{text[0].upper()}{text[1:]}.")
        one.add_argument("--name", help="of this instance only (default: of all)")
        add_looking_arguments(one, SECONDS, "to wait for them to answer")
        one.add_argument("--json", type=Path, metavar="FILE", help="write the replies there")
    return parser


def ask_running(given: Sequence[str]) -> int:
    """Have all daemons of outcomes pause or go on, or one; exit code 1 unless each one that is
    meant has done and remembers it.

    Raises SettingsError, and InhandError where nobody answers.
    """
    arguments = _parser().parse_args(given)
    if arguments.json is not None:
        require_writable_file(arguments.json)
    tables = load_rig_file(arguments.config).outcomes
    expected = expected_instances("outcomes", tables, arguments.name)
    request = OutcomesRequest(outcomes=arguments.name)

    def complete(replies: list[OutcomesReply]) -> bool:
        return bool(expected) and {reply.outcomes for reply in replies}.issuperset(expected)

    with open_look(arguments.config) as look:
        answers = look.ask(_PROCEDURES[arguments.verb], request, complete, arguments.seconds)
        replies = {reply.outcomes: reply for reply in answers}
        if not replies and not expected:
            raise nothing_heard(look.site, arguments.seconds)
    for name, reply in sorted(replies.items()):
        print(f"{name}: {'paused: nothing is measured' if reply.paused else 'measures'}")
    problems = [
        *(f"{name}: {reply.problem}" for name, reply in sorted(replies.items()) if reply.problem),
        *(f"{name} does not answer: {UNREACHED}" for name in expected if name not in replies),
    ]
    for line in problems:
        print(f"WRONG: {line}")
    if arguments.json is not None:
        rows = [msgspec.to_builtins(reply) for _, reply in sorted(replies.items())]
        write_json(arguments.json, {"outcomes": rows, "problems": problems})
    return FAILED if problems else DONE
