"""How many files and connections this process has open, and how many it may have."""

import contextlib
import resource

import psutil

MOST_OPEN = 16_384
"""Number that a process which serves many asks for: by itself a system allows 1,024."""


def allow_many() -> None:
    """Let this process have as many open as the system permits, ``MOST_OPEN`` at the most.

    A systemd unit permits no change, and says itself how many there may be.
    """
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = MOST_OPEN if hard == resource.RLIM_INFINITY else min(MOST_OPEN, hard)
    if soft != resource.RLIM_INFINITY and soft < wanted:
        with contextlib.suppress(OSError, ValueError):
            resource.setrlimit(resource.RLIMIT_NOFILE, (wanted, hard))


def count_open() -> int:
    """Return how many are open now; raises OSError where not even one more can be."""
    return psutil.Process().num_fds()
