#!/usr/bin/env bash
# eclipse-zenoh 1.10.2: the sockets of Zenoh's TCP links linger for 10 s when they are closed.
#
# One would bet on sockets as the system makes them, whose close returns at once while the system
# sends what is left, or on a setting that changes it. There is none, and each end of a link has
# SO_LINGER set. Where the other end takes nothing any more (a process that is stopped, a host that
# lost its network), closing the link holds the thread that closes it for these 10 s. That thread is
# one of those that send to others: a healthy link was seen to fall silent meanwhile, until its own
# lease ended and it was closed as well.
#
# So a process that must not fall silent switches it off at each link that opens, found by its ports
# among the process's own sockets.
#
# Output seen on 2026-11-30:
#   2 ends of a link, which linger for 10 and 10 s
#
# The script ends with 0 while that is so, and with 1 when it has changed.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check eclipse-zenoh==1.10.2 psutil
cat > "$folder/links.py" <<'PYTHON'
import json
import socket
import struct
import time

import psutil
import zenoh

with socket.socket() as probe:
    probe.bind(("127.0.0.1", 0))
    port = probe.getsockname()[1]


def peer(**endpoints: str) -> zenoh.Session:
    config = zenoh.Config()
    config.insert_json5("scouting/multicast/enabled", "false")
    for kind in ("listen", "connect"):
        given = [endpoints[kind]] if kind in endpoints else []
        config.insert_json5(f"{kind}/endpoints", json.dumps(given))
    return zenoh.open(config)


first = peer(listen=f"tcp/127.0.0.1:{port}")
second = peer(connect=f"tcp/127.0.0.1:{port}")
time.sleep(1.0)
linger = []
for one in psutil.Process().net_connections("tcp"):
    if one.raddr:
        end = socket.socket(fileno=one.fd)
        on, seconds = struct.unpack("ii", end.getsockopt(socket.SOL_SOCKET, socket.SO_LINGER, 8))
        end.detach()
        linger.append(seconds if on else 0)
print(len(linger), "ends of a link, which linger for", " and ".join(map(str, linger)), "s")
second.close()
first.close()
raise SystemExit(linger != [10, 10])
PYTHON
"$folder/venv/bin/python" "$folder/links.py"
