"""Stands for systemd: a socket at which services say that they are up, alive and how they are."""

import socket

WATCHDOG_S = 2.0


class Manager:
    """Stands for systemd: keeps what it is told, in order."""

    def __init__(self, address: str) -> None:
        self.address = address
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self._socket.bind(address.replace("@", "\0") if address.startswith("@") else address)
        self._socket.setblocking(False)
        self._heard: list[str] = []

    def environment(self, watchdog_s: float = WATCHDOG_S) -> dict[str, str]:
        """What a service that it starts finds."""
        return {"NOTIFY_SOCKET": self.address, "WATCHDOG_USEC": str(int(watchdog_s * 1e6))}

    def heard(self) -> list[str]:
        """All that was said so far."""
        while True:
            try:
                self._heard.append(self._socket.recv(4096).decode())
            except BlockingIOError:
                return self._heard

    def beats(self) -> int:
        """How often the watchdog was fed so far."""
        return self.heard().count("WATCHDOG=1")

    def close(self) -> None:
        """Listen no more."""
        self._socket.close()
