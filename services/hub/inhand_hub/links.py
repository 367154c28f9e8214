"""Looks who is connected with a hub: who is unknown to its rules, or there too often, and whether
many wait at its door."""

import time
from collections.abc import Callable, Collection, Mapping, Sequence

from inhand_runtime.daemon import Daemon
from inhand_runtime.open_files import count_open

from inhand_hub.parameters import DEFAULT_HUB


class LinksWatch:
    """Says in a hub's health what is wrong with those who are connected, or want to be."""

    def __init__(
        self, daemon: Daemon, known: Collection[str], now: Callable[[], float] = time.monotonic
    ) -> None:
        """``known`` are the common names of all that the hub's rules let do anything."""
        self._daemon = daemon
        self._known = frozenset(known)
        self._now = now
        self._next_look = now()
        self._said: dict[str, set[str]] = {}

    def look(self) -> None:
        """Look from time to time."""
        if self._now() < self._next_look:
            return
        self._next_look = self._now() + DEFAULT_HUB.look_s
        hosts = self._daemon.certified()
        self._say("stranger", self._strangers(hosts))
        self._say("crowd", _crowds(hosts))
        self._say("door", self._door())

    def _say(self, kind: str, texts: Mapping[str, str]) -> None:
        """Have these troubles of a kind, by whom they are of, and no others of it."""
        for gone in self._said.get(kind, set()) - set(texts):
            self._daemon.health.well(f"{kind} {gone}")
        for who, text in texts.items():
            self._daemon.health.trouble(f"{kind} {who}", text)
        self._said[kind] = set(texts)

    def _strangers(self, hosts: Mapping[str, Sequence[str]]) -> dict[str, str]:
        """Zenoh lets in whom the authority ever let in, and nothing of them goes through."""
        return {
            who: f"{who}, which is no member, was revoked perhaps, is connected from {at[0]}, and "
            "nothing of it goes through: end what shows this certificate there"
            for who, at in hosts.items()
            if who not in self._known
        }

    def _door(self) -> dict[str, str]:
        """Each connection that never becomes a link keeps those behind it waiting."""
        try:
            if count_open() - self._daemon.count_links() <= DEFAULT_HUB.waiting:
                return {}
            problem = f"more than {DEFAULT_HUB.waiting} connections show no valid certificate"
        except OSError as error:
            problem = f"no more connections can be taken ({error.strerror})"
        return {
            "": f"{problem}: who is connected goes on, who comes may wait for long; see from where "
            "they come (ss -tn), and have a firewall let fewer through"
        }


def _crowds(hosts: Mapping[str, Sequence[str]]) -> dict[str, str]:
    return {
        who: f"{who} is connected more than {DEFAULT_HUB.links_of_one} times, last from {at[-1]}, "
        "and a hub has room for 1,000 links in all: end what connects so often there, or "
        "`inhand hub revoke`"
        for who, at in hosts.items()
        if len(at) > DEFAULT_HUB.links_of_one
    }
