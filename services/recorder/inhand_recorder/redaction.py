"""What a recording says of what was hidden in it."""

from collections.abc import Iterator, Mapping

REDACTION_RECORD = "redaction"
"""The name of the metadata record on what was hidden; of former redactions it is that and ``of
FILE``."""


def redaction_lines(metadata: Mapping[str, Mapping[str, str]]) -> Iterator[str]:
    """Yield a line for each time that something was hidden."""
    for name, values in sorted(metadata.items()):
        if name == REDACTION_RECORD or name.startswith(f"{REDACTION_RECORD} of "):
            rest = {key: one for key, one in values.items() if key not in ("hidden", "version")}
            told = ", ".join(f"{key} {one}" for key, one in rest.items())
            yield (
                f"{values.get('hidden', 'something')} hidden by "
                f"{values.get('version', 'an unknown program')}: {told}"
            )
