"""A process with nothing but a session: says how many others it knows, each time that changes."""

import sys
import time

from inhand_runtime.session import open_session
from inhand_runtime.settings import ZenohSettings

with open_session(ZenohSettings(meeting=sys.argv[1])) as session:
    known = -1
    while True:
        now = len(session.info.peers_zid())
        if now != known:
            known = now
            print(f"knows {known}", flush=True)
        time.sleep(0.01)
