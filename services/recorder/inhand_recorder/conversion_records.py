"""The named records of a converted recording: what of its sources' is carried over, and how."""

from collections import Counter
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

from inhand_recorder.clips import CLIP_RECORD
from inhand_recorder.clock import CLOCK_RECORD, format_clock_steps, parse_clock_steps
from inhand_recorder.journal import PAUSES_RECORD
from inhand_recorder.losses import LOSSES_RECORD, LossCounter, format_losses, parse_losses
from inhand_recorder.provenance import OBJECTS_RECORD, PUBLISHERS_RECORD, with_publisher

CONVERSION_RECORD = "conversion"
"""The name of the metadata record in which a converted file says what it was made of."""
_JOINED = (PAUSES_RECORD, PUBLISHERS_RECORD, OBJECTS_RECORD, CLIP_RECORD)
"""Names of records that are lists, of times or of names."""

Records = Mapping[str, dict[str, str]]


def records_of(
    sources: Mapping[Path, Records], counter: LossCounter, span_ns: tuple[int, int] | None
) -> dict[str, dict[str, str]]:
    """Return the records of a file but that on its conversion.

    ``counter`` has counted its messages. ``span_ns`` are the times of reception of the first and
    last of them; None where the file holds all that its sources do: then drops are known too.
    """
    records = _carried(sources)
    steps = {
        at_ns: step_ns
        for one in sources.values()
        for at_ns, step_ns in parse_clock_steps(one.get(CLOCK_RECORD, {})).items()
        if span_ns is None or span_ns[0] <= at_ns <= span_ns[1]
    }
    if steps:
        records[CLOCK_RECORD] = format_clock_steps(steps)
    dropped, unwritten = _dropped(sources) if span_ns is None else ({}, {})
    counted = counter.losses()
    of_counted = {key: number for key, number in dropped.items() if key in counted}
    records[LOSSES_RECORD] = format_losses(counter.losses(of_counted, unwritten))
    return records


def losses_by_source(sources: Mapping[Path, Records]) -> dict[str, str]:
    """Return what each source says that it lost, a line for each key."""
    return {
        f"losses of {path.name}": "\n".join(
            f"{key} {losses}" for key, losses in records.get(LOSSES_RECORD, {}).items()
        )
        for path, records in sources.items()
    }


def _carried(sources: Mapping[Path, Records]) -> dict[str, dict[str, str]]:
    """Return the sources' records but those that are made anew.

    Lists of pauses, publishers, objects and clips are joined; where other records differ under one
    name, the later ones are named after their file as well.
    """
    records: dict[str, dict[str, str]] = {}
    for path, of_file in sources.items():
        for name, values in of_file.items():
            if name in (CLOCK_RECORD, LOSSES_RECORD):
                continue
            if name in _JOINED:
                known = records.setdefault(name, {})
                if name == PUBLISHERS_RECORD:
                    values = {k: with_publisher(known.get(k, ""), v) for k, v in values.items()}
                known.update({key: one for key, one in values.items() if one or key not in known})
                continue
            if name == CONVERSION_RECORD or records.get(name, values) != values:
                name = f"{name} of {path.name}"
            records[name] = values
    return records


def _dropped(
    sources: Mapping[Path, Records],
) -> tuple[Counter[str], Counter[str]]:
    """Return the drops by key, and those among them that the disk did not take."""
    dropped, unwritten = Counter[str](), Counter[str]()
    for records in sources.values():
        with suppress(ValueError):
            for key, losses in parse_losses(records.get(LOSSES_RECORD, {})).items():
                dropped[key] += losses.dropped
                unwritten[key] += losses.unwritten
    return dropped, unwritten
