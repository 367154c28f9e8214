"""Any bytes at all are a valid message or a MessageError: no crash, no hang."""

import random
import time
from collections.abc import Iterator

import pytest
from examples import EXAMPLES
from hypothesis import given
from hypothesis import strategies as st
from inhand_schemas.errors import MessageError
from inhand_schemas.topics import TOPICS, AnyTopic
from make_golden import GOLDEN

SECONDS_AN_INPUT = 1.0

HUGE_HEADERS = (
    b"\xd9\xff",
    b"\xda\xff\xff",
    b"\xdb\xff\xff\xff\xff",
    b"\xc4\xff",
    b"\xc6\xff\xff\xff\xff",
    b"\xc9\x7f\xff\xff\xff\x01",
    b"\xdc\xff\xff",
    b"\xdd\xff\xff\xff\xff",
    b"\xdd\x7f\xff\xff\xff",
    b"\xde\xff\xff",
    b"\xdf\xff\xff\xff\xff",
    b"\xcf\xff\xff\xff\xff\xff\xff\xff\xff",
    b"\xd3\x80\x00\x00\x00\x00\x00\x00\x00",
    b"\xcb\x7f\xf8\x00\x00\x00\x00\x00\x00",
    b"\xcb\x7f\xf0\x00\x00\x00\x00\x00\x00",
    b"\xc1",
)

SEEDS = [
    (topic, (GOLDEN / f"{topic.message_type.__name__}.v1.msgpack").read_bytes())
    for topic in TOPICS.values()
]


def flipped(data: bytearray, rng: random.Random) -> None:
    for _ in range(rng.randint(1, 4)):
        data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)


def truncated(data: bytearray, rng: random.Random) -> None:
    del data[rng.randrange(len(data)) :]


def header_inserted(data: bytearray, rng: random.Random) -> None:
    place = rng.randrange(len(data))
    data[place:place] = rng.choice(HUGE_HEADERS)


def header_written_over(data: bytearray, rng: random.Random) -> None:
    header = rng.choice(HUGE_HEADERS)
    place = rng.randrange(len(data))
    data[place : place + len(header)] = header


def spliced(data: bytearray, rng: random.Random) -> None:
    _, other = rng.choice(SEEDS)
    start = rng.randrange(len(other))
    place = rng.randrange(len(data))
    data[place : place + rng.randint(0, 30)] = other[start : start + rng.randint(0, 30)]


def replaced(data: bytearray, rng: random.Random) -> None:
    data[:] = rng.randbytes(rng.randint(0, 200))


MUTATIONS = (flipped, truncated, header_inserted, header_written_over, spliced, replaced)


def inputs(number: int, seed: int) -> Iterator[tuple[AnyTopic, bytes]]:
    rng = random.Random(seed)
    for _ in range(number):
        topic, golden = rng.choice(SEEDS)
        data = bytearray(golden)
        for _ in range(rng.choice((1, 1, 2, 3))):
            if data:
                rng.choice(MUTATIONS)(data, rng)
        yield topic, bytes(data)


def decodes(topic: AnyTopic, data: bytes) -> bool:
    """Whether ``data`` is valid; any other end than MessageError goes through. A look at it has to
    find the same."""
    start = time.monotonic()
    try:
        message = topic.decode(data)
    except MessageError:
        with pytest.raises(MessageError):
            topic.check(data)
        return False
    finally:
        assert time.monotonic() - start < SECONDS_AN_INPUT
    assert topic.decode(topic.encode(message)) == message
    topic.check(data)
    return True


@pytest.mark.parametrize(
    "number", [5_000, pytest.param(100_000, marks=pytest.mark.long)], ids=["few", "many"]
)
def test_mutated_messages_are_valid_or_a_message_error(number: int) -> None:
    valid = sum(decodes(topic, data) for topic, data in inputs(number, seed=number))
    assert 0 < valid < number


@given(st.sampled_from(list(TOPICS.values())), st.binary())
def test_random_bytes_are_valid_or_a_message_error(topic: AnyTopic, data: bytes) -> None:
    decodes(topic, data)


@pytest.mark.parametrize("nest", [b"\x91", b"\x81\xa1x", b"\x81\xa6people", b"\xdc\x00\x01"])
@pytest.mark.parametrize("start", [b"", b"\x81\xa6people\x91", b"\x81\xa5later"])
def test_deep_nesting_is_a_message_error(start: bytes, nest: bytes) -> None:
    for topic in TOPICS.values():
        assert not decodes(topic, start + nest * 1_000_000)


@pytest.mark.parametrize("header", HUGE_HEADERS, ids=lambda header: header.hex())
def test_huge_declared_sizes_are_a_message_error(header: bytes) -> None:
    for topic, golden in SEEDS:
        for place in range(len(golden)):
            decodes(topic, golden[:place] + header)


def test_every_cut_of_a_message_is_a_message_error() -> None:
    for topic, golden in SEEDS:
        for length in range(len(golden)):
            assert not decodes(topic, golden[:length])


def test_golden_seeds_are_valid() -> None:
    assert len(SEEDS) == len(EXAMPLES) + 1
    assert all(decodes(topic, golden) for topic, golden in SEEDS)
