"""A process with nothing but a session: says how many others it knows, each time that changes.

On SIGUSR1 it breaks all links but the one to the meeting address, as a network does.
"""

import signal
import socket
import sys
import time
from types import FrameType

import psutil
from inhand_runtime.session import connected, open_session
from inhand_runtime.settings import ZenohSettings

MEETING = sys.argv[1]


def break_links(_number: int, _frame: FrameType | None) -> None:
    port = int(MEETING.rsplit(":", 1)[1])
    for one in psutil.Process().net_connections("tcp"):
        if one.raddr and port not in (one.laddr.port, one.raddr.port):
            with socket.fromfd(one.fd, socket.AF_INET, socket.SOCK_STREAM) as link:
                link.shutdown(socket.SHUT_RDWR)


signal.signal(signal.SIGUSR1, break_links)
with open_session(ZenohSettings(meeting=MEETING)) as session:
    known = -1
    while True:
        now = len(connected(session))
        if now != known:
            known = now
            print(f"knows {known}", flush=True)
        time.sleep(0.01)
