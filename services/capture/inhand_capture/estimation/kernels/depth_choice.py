"""Chooses, for a person's joints, which of the surfaces about their pixels they lie under.

A joint may lie under any of the clusters of depth about its pixel, or be hidden: then a limb's
length and its upper end leave two places on the pixel's ray, one near and one far. A choice costs
what it departs from the network's depths and from the expected lengths, each up to a bound, and
that it is hidden.
"""

import numpy as np
from inhand_runtime.compiled import njit

TRACKED, INFERRED = 2, 1


@njit(cache=True, nogil=True)
def middle_depth(candidates, shares, counts, relative, trust, spread):  # type: ignore[no-untyped-def]
    """Return the depth of the middle of the hips that most joints agree with, in metres.

    ``candidates`` (J, K) are depths at which joints may lie, the first ``counts`` (J,) of each row,
    with the ``shares`` (J, K) of their windows; ``relative`` (J,) are the network's depths behind
    the middle of the hips, and ``trust`` (J,) its visibilities. Agreement falls with a ``spread``,
    metres. NaN where no joint has a candidate.
    """
    best, best_score = np.nan, 0.0
    for joint in range(len(counts)):
        for one in range(counts[joint]):
            middle = candidates[joint, one] - relative[joint]
            score = weighted = 0.0
            for other in range(len(counts)):
                most = nearest = 0.0
                for two in range(counts[other]):
                    place = candidates[other, two] - relative[other]
                    away = (place - middle) / spread
                    agreement = np.exp(-0.5 * away * away) * shares[other, two] * trust[other]
                    if agreement > most:
                        most, nearest = agreement, place
                score += most
                weighted += most * nearest
            if score > best_score:
                best, best_score = weighted / score, score
    return best


@njit(cache=True, nogil=True)
def on_ray(direction, depth):  # type: ignore[no-untyped-def]
    """Return the point (3,) at a depth on a ray x, y, 1."""
    return np.array((direction[0] * depth, direction[1] * depth, depth))


@njit(cache=True, nogil=True)
def distance(first, second):  # type: ignore[no-untyped-def]
    """Return the distance of two points (3,)."""
    return np.sqrt(
        (first[0] - second[0]) ** 2 + (first[1] - second[1]) ** 2 + (first[2] - second[2]) ** 2
    )


@njit(cache=True, nogil=True)
def depths_at_length(direction, end, length):  # type: ignore[no-untyped-def]
    """Return the two depths at which a ray is so far from a limb's upper end (3,), near and far.

    Where it never comes as close they are both that of the ray's nearest point.
    """
    square = direction[0] ** 2 + direction[1] ** 2 + 1.0
    along = (direction[0] * end[0] + direction[1] * end[1] + end[2]) / square
    rest = end[0] ** 2 + end[1] ** 2 + end[2] ** 2 - length * length
    inside = along * along - rest / square
    half = np.sqrt(max(inside, 0.0))
    return along - half, along + half


@njit(cache=True, nogil=True)
def bounded(away, bound):  # type: ignore[no-untyped-def]
    """Return a square that is not above a bound."""
    return min(away * away, bound)


@njit(cache=True, nogil=True)
def departure(child, parent, turn, length, before, costs):  # type: ignore[no-untyped-def]
    """Return the cost of a joint (3,) after its parent (3,).

    ``turn`` is by how much the network says that it is farther away, metres; NaN for no word, as
    for an unknown ``length``, and for the joint's place of ``before`` (3,). ``costs`` are the
    deviation of such depths (metres), that of lengths (a share), that of a movement (metres), the
    bound of a cost, and the cost of a hidden joint.
    """
    cost = 0.0
    if not np.isnan(turn):
        cost += bounded((child[2] - parent[2] - turn) / costs[0], costs[3])
    if not np.isnan(length):
        cost += bounded((distance(child, parent) - length) / (costs[1] * length), costs[3])
    if not np.isnan(before[2]):
        cost += bounded((child[2] - before[2]) / costs[2], costs[3])
    return cost


@njit(cache=True, nogil=True)
def options_of(candidates, count, direction, parent, turn, length):  # type: ignore[no-untyped-def]
    """Return the depths (M,) at which a joint may lie.

    The first ``count`` are its candidates (K,), the others where it may hide by its parent (3,).
    """
    options = np.empty(count + 3)
    options[:count] = candidates[:count]
    more = count
    if not np.isnan(length):
        options[count], options[count + 1] = depths_at_length(direction, parent, length)
        more += 2
    if not np.isnan(turn) or more == 0:
        options[more] = parent[2] + (0.0 if np.isnan(turn) else turn)
        more += 1
    return options[:more]


@njit(cache=True, nogil=True)
def choose_limb(chain, first, candidates, counts, rays, relative, lengths, before, costs):  # type: ignore[no-untyped-def]
    """Return the cheapest places (L, 3) and states (L,) of a limb's joints after its first.

    ``chain`` (1 + L,) are its joints from the trunk outwards and ``first`` (3,) the place of the
    first of them; ``candidates``, ``counts`` and ``relative`` are as for ``middle_depth``, ``rays``
    (J, 2) directions, ``lengths`` (J,) from each joint to the one before, ``before`` (J, 3) where
    the joints were. All combinations are tried, but those that cost too much early on.
    """
    links = len(chain) - 1
    best = np.inf
    places, states = np.full((links, 3), np.nan), np.zeros(links, np.uint8)
    trial, option = np.empty((links, 3)), np.full(links, -1)
    costs_so_far = np.zeros(links + 1)
    options = np.empty((links, candidates.shape[1] + 3))
    sizes = np.zeros(links, np.int64)
    link, entered = 0, True
    while link >= 0:
        joint = chain[link + 1]
        parent = first if link == 0 else trial[link - 1]
        turn = relative[joint] - relative[chain[link]]
        if entered:
            depths = options_of(
                candidates[joint], counts[joint], rays[joint], parent, turn, lengths[joint]
            )
            sizes[link], option[link] = len(depths), -1
            options[link, : len(depths)] = depths
        option[link] += 1
        entered = False
        if option[link] == sizes[link]:
            link -= 1
            continue
        place = on_ray(rays[joint], options[link, option[link]])
        hidden = costs[4] if option[link] >= counts[joint] else 0.0
        cost = costs_so_far[link] + hidden
        cost += departure(place, parent, turn, lengths[joint], before[joint], costs)
        if cost >= best:
            continue
        trial[link] = place
        costs_so_far[link + 1] = cost
        if link + 1 < links:
            link, entered = link + 1, True
            continue
        best = cost
        for one in range(links):
            places[one] = trial[one]
            states[one] = TRACKED if option[one] < counts[chain[one + 1]] else INFERRED
    return places, states
