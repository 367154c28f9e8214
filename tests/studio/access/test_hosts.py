"""Host names and origins that a request may carry."""

import pytest
from inhand_studio.access.hosts import host_is_known, origin_is_own

OWN = ("localhost", "localhost:8730", "LOCALHOST.", "127.0.0.1:8730", "127.9.8.7", "[::1]:8730")
ADDRESSES = ("192.168.1.5:8730", "10.0.0.1", "[fe80::1]:8730")
FOREIGN = (None, "", "evil.example", "localhost.evil.example:8730", "127.0.0.1.evil.example")
ODD = ("localhost:8730:1", "a b", "localhost/x", "evil.example@localhost", "[::1", "127.1;evil")


@pytest.mark.parametrize("elsewhere", [False, True])
def test_names_of_this_machine_are_known_and_those_of_others_are_not(elsewhere: bool) -> None:
    assert all(host_is_known(host, (), elsewhere=elsewhere) for host in OWN)
    assert not any(host_is_known(host, (), elsewhere=elsewhere) for host in FOREIGN + ODD)


def test_other_addresses_are_known_where_other_machines_reach_the_studio() -> None:
    assert all(host_is_known(host, (), elsewhere=True) for host in ADDRESSES)
    assert not any(host_is_known(host, (), elsewhere=False) for host in ADDRESSES)


def test_a_configured_name_is_known_in_any_case_and_at_any_port() -> None:
    assert host_is_known("Kitchen.local:9000", ("kitchen.local",), elsewhere=False)
    assert not host_is_known("xkitchen.local", ("kitchen.local",), elsewhere=True)


@pytest.mark.parametrize(
    ("origin", "host", "own"),
    [
        ("http://localhost:8730", "localhost:8730", True),
        ("https://kitchen.local", "kitchen.local", True),
        ("https://kitchen.local:443", "kitchen.local", True),
        ("http://[::1]:8730", "[::1]:8730", True),
        ("http://localhost:3000", "localhost:8730", False),
        ("http://localhost", "localhost:8730", False),
        ("http://127.0.0.1:8730", "localhost:8730", False),
        ("https://evil.example", "localhost:8730", False),
        ("file://", "localhost", False),
        ("null", "localhost", False),
        ("http://localhost:99999", "localhost:8730", False),
        (None, "localhost", False),
    ],
)
def test_an_origin_is_own_where_the_host_itself_served_the_page(
    origin: str | None, host: str, own: bool
) -> None:
    assert origin_is_own(origin, host) is own
