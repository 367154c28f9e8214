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
def departure(child, parent, turn, length, costs):  # type: ignore[no-untyped-def]
    """Return the cost of a joint (3,) after its parent (3,).

    ``turn`` is by how much the network says that it is farther away, metres; NaN for no word.
    ``costs`` are the deviation of such depths (metres), that of lengths (a share), the bound of a
    cost, and the cost of a hidden joint.
    """
    cost = 0.0
    if not np.isnan(turn):
        cost += bounded((child[2] - parent[2] - turn) / costs[0], costs[2])
    if not np.isnan(length):
        cost += bounded((distance(child, parent) - length) / (costs[1] * length), costs[2])
    return cost


@njit(cache=True, nogil=True)
def options_of(joint, parent, candidates, counts, direction, turn, length, middle):  # type: ignore[no-untyped-def]
    """Return the depths (M,) at which a joint may lie, and how many of them were measured.

    The others are where it may hide, by its parent (3,).
    """
    count = counts[joint]
    options = np.empty(count + 3)
    options[:count] = candidates[joint, :count]
    more = count
    if not np.isnan(length):
        options[count], options[count + 1] = depths_at_length(direction, parent, length)
        more += 2
    if not np.isnan(turn) or more == 0:
        options[more] = parent[2] + (0.0 if np.isnan(turn) else turn)
        more += 1
    return options[:more], count


@njit(cache=True, nogil=True)
def choose_limb(chain, first, candidates, counts, rays, relative, lengths, costs):  # type: ignore[no-untyped-def]
    """Return the best places (3, 3) and states (3,) of a limb's joints after its first.

    ``chain`` (4,) are its joints from the trunk outwards and ``first`` (3,) the place of the first
    of them; ``candidates``, ``counts`` and ``relative`` are as for ``middle_depth``, ``rays``
    (J, 2) directions, ``lengths`` (J,) from each joint to the one before, NaN where unknown.
    Joints whose rays are not known have NaN.
    """
    best = np.inf
    places, states = np.full((3, 3), np.nan), np.zeros(3, np.uint8)
    a, b, c = chain[1], chain[2], chain[3]
    turn_a, turn_b = relative[a] - relative[chain[0]], relative[b] - relative[a]
    turn_c = relative[c] - relative[b]
    depths_a, seen_a = options_of(a, first, candidates, counts, rays[a], turn_a, lengths[a], 0.0)
    for i in range(len(depths_a)):
        place_a = on_ray(rays[a], depths_a[i])
        cost_a = departure(place_a, first, turn_a, lengths[a], costs)
        cost_a += 0.0 if i < seen_a else costs[3]
        if cost_a >= best:
            continue
        depths_b, seen_b = options_of(
            b, place_a, candidates, counts, rays[b], turn_b, lengths[b], 0.0
        )
        for j in range(len(depths_b)):
            place_b = on_ray(rays[b], depths_b[j])
            cost_b = cost_a + departure(place_b, place_a, turn_b, lengths[b], costs)
            cost_b += 0.0 if j < seen_b else costs[3]
            if cost_b >= best:
                continue
            depths_c, seen_c = options_of(
                c, place_b, candidates, counts, rays[c], turn_c, lengths[c], 0.0
            )
            if np.isnan(rays[c, 0]):
                depths_c = depths_c[:1]
            for k in range(len(depths_c)):
                place_c = on_ray(rays[c], depths_c[k])
                cost = cost_b
                if not np.isnan(rays[c, 0]):
                    cost += departure(place_c, place_b, turn_c, lengths[c], costs)
                    cost += 0.0 if k < seen_c else costs[3]
                if cost < best:
                    best = cost
                    places[0], places[1], places[2] = place_a, place_b, place_c
                    states[0] = TRACKED if i < seen_a else INFERRED
                    states[1] = TRACKED if j < seen_b else INFERRED
                    states[2] = TRACKED if k < seen_c else INFERRED
    return places, states
