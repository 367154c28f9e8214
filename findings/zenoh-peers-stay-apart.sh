#!/usr/bin/env bash
# eclipse-zenoh 1.10.2: two peers that met by gossip and lose their link stay apart for ever.
#
# Three peers: two connect to the first, and are told of each other, so each knows two others. Then
# the connection between those two breaks, as it does where one of them is suspended for some seconds.
# One would bet that they connect again, since both still have links to the first, which knows both,
# and since Zenoh retries the addresses of its settings. They never do: gossip is sent to newcomers
# only. As soon as anybody joins, all are connected again.
#
# So a peer that sees another one go opens a second session for a moment, by which all meet again.
#
# Output seen on 2026-11-29:
#   before: 2 2
#   20 s after the link broke: 1 1
#   after somebody joined: 3 3
#
# The script ends with 0 while that is so, and with 1 when it has changed.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check eclipse-zenoh==1.10.2 psutil
cat > "$folder/peers.py" <<'PYTHON'
import json
import socket
import time

import psutil
import zenoh

with socket.socket() as probe:
    probe.bind(("127.0.0.1", 0))
    port = probe.getsockname()[1]
MEETING = f"tcp/127.0.0.1:{port}"


def peer(listen: str, *connect: str) -> zenoh.Session:
    config = zenoh.Config()
    for key, value in {
        "mode": "peer",
        "scouting/multicast/enabled": False,
        "listen/endpoints": [listen],
        "connect/endpoints": list(connect),
    }.items():
        config.insert_json5(key, json.dumps(value))
    return zenoh.open(config)


def known(*sessions: zenoh.Session) -> list[int]:
    return [len(list(session.info.peers_zid())) for session in sessions]


first = peer(MEETING)
others = [peer("tcp/127.0.0.1:0", MEETING) for _ in range(2)]
time.sleep(2.0)
before = known(*others)
print("before:", *before)
for one in psutil.Process().net_connections("tcp"):
    if one.raddr and port not in (one.laddr.port, one.raddr.port):
        with socket.fromfd(one.fd, socket.AF_INET, socket.SOCK_STREAM) as link:
            try:
                link.shutdown(socket.SHUT_RDWR)
            except OSError:  # the other end of the same connection was first
                pass
time.sleep(20.0)
apart = known(*others)
print("20 s after the link broke:", *apart)
newcomer = peer("tcp/127.0.0.1:0", MEETING)
time.sleep(2.0)
joined = known(*others)
print("after somebody joined:", *joined)
for session in (newcomer, *others, first):
    session.close()
raise SystemExit((before, apart, joined) != ([2, 2], [1, 1], [3, 3]))
PYTHON
"$folder/venv/bin/python" "$folder/peers.py"
