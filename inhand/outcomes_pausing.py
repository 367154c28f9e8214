"""``inhand outcomes pause`` and ``resume``: words to daemons of outcomes that run."""

from collections.abc import Sequence

from inhand_runtime.settings import load_rig_file
from inhand_runtime.writable import require_writable_file
from inhand_schemas.procedures import PAUSE_MEASURING, RESUME_MEASURING, OutcomesRequest

from inhand.asking import ask_instances, asking_parser, conclude
from inhand.looking import expected_instances
from inhand.outcomes_words import ASKED

_PROCEDURES = {one.verb: one for one in (PAUSE_MEASURING, RESUME_MEASURING)}


def ask_running(given: Sequence[str]) -> int:
    """Have all daemons of outcomes pause or go on, or one; exit code 1 unless each one that is
    meant has done and remembers it.

    Raises SettingsError, and InhandError where nobody answers.
    """
    parser = asking_parser("outcomes", "daemons", ASKED, named="instance")
    arguments = parser.parse_args(given)
    if arguments.json is not None:
        require_writable_file(arguments.json)
    tables = load_rig_file(arguments.config).outcomes
    expected = expected_instances("outcomes", tables, arguments.name)
    procedure, request = _PROCEDURES[arguments.verb], OutcomesRequest(outcomes=arguments.name)
    _, replies = ask_instances(procedure, request, expected, arguments.config, arguments.seconds)
    for name, reply in replies.items():
        print(f"{name}: {'paused: nothing is measured' if reply.paused else 'measures'}")
    return conclude(replies, expected, "outcomes", arguments.json)
