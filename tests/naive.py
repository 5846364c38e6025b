"""Every synthesis kernel once more, in a few lines of NumPy that anyone can check against the formula."""

import numpy as np
from numpy import ndarray


def bilinear(image: ndarray, row: float, column: float) -> ndarray:
    """The image (row, column, channel) at any place, clamped at its border."""
    row, column = np.clip(row, 0, image.shape[0] - 1), np.clip(column, 0, image.shape[1] - 1)
    r, c = int(row), int(column)
    down, right = min(r + 1, image.shape[0] - 1), min(c + 1, image.shape[1] - 1)
    upper = (1 - (column - c)) * image[r, c] + (column - c) * image[r, right]
    lower = (1 - (column - c)) * image[down, c] + (column - c) * image[down, right]
    return (1 - (row - r)) * upper + (row - r) * lower


def read_patches(sites: ndarray, weights: ndarray, colour: ndarray, label: ndarray) -> tuple[ndarray, ndarray]:
    """Mean of the coloured corners of every sample, and where they hold half of the weight or more."""
    there = np.where((sites >= 0) & (label[sites] >= 0), weights, 0.0)
    total = there.sum(2)
    mean = (there[..., None] * colour[sites]).sum(2) / np.maximum(total, 1e-9)[..., None]
    return np.where((total >= 0.5)[..., None], mean, 0.0), (total >= 0.5).astype(float)


def block_cost(image: ndarray, anchor: tuple[int, int], values: ndarray, known: ndarray, stride: int = 1) -> float:
    """Mean squared difference of a block to a patch (row, column, channel), over its known samples."""
    r, c = anchor
    width = len(values)
    squares = ((image[r : r + width, c : c + width] - values) ** 2).sum(2)[::stride, ::stride]
    return float((known[::stride, ::stride] * squares).sum() / (known[::stride, ::stride].sum() + 1e-6))


def refine_anchor(
    image: ndarray, usable: ndarray, anchor: ndarray, reach: int, values: ndarray, known: ndarray, stride: int
) -> tuple[ndarray, float]:
    """The cheapest usable anchor around one, the first in scan-line order among equals."""
    steps = np.mgrid[-reach : reach + 1, -reach : reach + 1].reshape(2, -1).T + anchor
    inside = (steps >= 0).all(1) & (steps < usable.shape).all(1)
    steps = [place for place in steps[inside] if usable[tuple(place)]]
    costs = [block_cost(image, place, values, known, stride) for place in steps]
    return steps[int(np.argmin(costs))], min(costs)


def seam_costs(
    image: ndarray, ring: ndarray, anchor: tuple[int, int], values: ndarray, known: ndarray, floor: float
) -> ndarray:
    """(step around, depth): what a seam pays at every place of the unrolled border."""
    row, column = ring[..., 0], ring[..., 1]
    squares = ((image[anchor[0] + row, anchor[1] + column] - values[row, column]) ** 2).sum(2)
    return np.where(known[row, column] > 0, squares + floor, 0.0)


def cheapest_path(cost: ndarray) -> tuple[float, ndarray]:
    """Least cost over the steps of paths moving at most one deep a step, and the path; the shallowest of equals."""
    best = cost[0].astype(float)
    back = []
    for row in cost[1:]:
        padded = np.pad(best, 1, constant_values=np.inf)
        choices = np.stack([padded[1:-1], padded[:-2], padded[2:]])  # straight on, from the shallower, from the deeper
        back.append(np.arange(len(best)) + np.array([0, -1, 1])[choices.argmin(0)])
        best = choices.min(0) + row
    path = [int(best.argmin())]
    for step in reversed(back):
        path.append(int(step[path[-1]]))
    return float(best.min()), np.array(path[::-1])


def cheapest_closed_path(cost: ndarray) -> float:
    """The same for paths that end at most one deep from where they begin: every beginning is tried."""
    depth = cost.shape[1]
    totals = []
    for first in range(depth):
        fenced = cost.astype(float).copy()
        fenced[0, np.arange(depth) != first] = np.inf
        fenced[-1, np.abs(np.arange(depth) - first) > 1] = np.inf
        totals.append(cheapest_path(fenced)[0])
    return min(totals)


def average_patches(
    cover: list[list[tuple[int, float, float]]], anchors: ndarray, weight: ndarray, scale: float, image: ndarray
) -> ndarray:
    """Weighted mean of what the patches over every site show; ``cover[site]`` lists (patch, row, column)."""
    means = []
    for entries in cover:
        shown = [weight[p] * bilinear(image, *(anchors[p] + scale * np.array([r, c]))) for p, r, c in entries]
        means.append(np.sum(shown, axis=0) / sum(weight[p] for p, _, _ in entries))
    return np.array(means)


def heaviest_patches(cover: list[list[int]], weight: ndarray, most: int) -> tuple[ndarray, ndarray]:
    """Cover entries of the heaviest patches of every site, the first of equals first, and their shares."""
    entry, share = np.full((len(cover), most), -1), np.zeros((len(cover), most))
    first = 0
    for site, patches in enumerate(cover):
        order = sorted(range(len(patches)), key=lambda k: (-weight[patches[k]], k))[:most]
        entry[site, : len(order)] = [first + k for k in order]
        share[site, : len(order)] = [weight[patches[k]] for k in order]
        share[site] /= max(share[site].sum(), 1e-30)
        first += len(patches)
    return entry, share


def feather_layers(
    cover: list[list[tuple[int, float, float]]], rank: ndarray, width: int, zone: float, most: int
) -> tuple[ndarray, ndarray]:
    """Cover entries of the latest patches over every site, and what shows of each through those above."""
    entry, share = np.full((len(cover), most), -1), np.zeros((len(cover), most))
    first = 0
    for site, entries in enumerate(cover):
        left = 1.0
        order = sorted(range(len(entries)), key=lambda k: -rank[entries[k][0]])
        for layer, k in enumerate(order[:most]):
            if left <= 0:
                break
            _, row, column = entries[k]
            depth = min(row, column, width - 1 - row, width - 1 - column)
            opaque = min(max((depth + 0.5) / zone, 0.0), 1.0)
            entry[site, layer], share[site, layer] = first + k, left * opaque
            left *= 1 - opaque
        kept = np.count_nonzero(entry[site] >= 0)
        if kept:
            share[site, kept - 1] += left
        first += len(entries)
    return entry, share


def turned(offset: ndarray, angle: float) -> ndarray:
    """[row, column] as read in axes turned by ``angle``."""
    (row, column), cosine, sine = offset, np.cos(angle), np.sin(angle)
    return np.array([cosine * row + sine * column, cosine * column - sine * row])


def nearest_window(windows: ndarray, mean: ndarray, axes: ndarray, seen: ndarray) -> int:
    """The window whose components are nearest to those of what is seen, (sample, channel) each; the first of equals."""
    flat = axes.reshape(-1, axes.shape[-1]).astype(float)
    away = (windows - seen).reshape(len(windows), -1) @ flat
    return int((away**2).sum(1).argmin())


def correct_site(
    image: ndarray,
    usable: ndarray,
    similar: ndarray,
    near: tuple[ndarray, ndarray, ndarray],
    shown: tuple[ndarray, ndarray, ndarray],
    samples: tuple[ndarray, ndarray, ndarray],
    most: int,
    window: ndarray | None = None,
) -> tuple[ndarray, float, float]:
    """Position and turn of the cheapest candidate for one neighbourhood, and its mean squared difference.

    ``near`` are the sites whose sources are tried, the middle one first, their offsets, and the angles by which the
    middle one's frame is turned against theirs. ``shown`` is every site's position, turn and label: sites without a
    label suggest nothing. ``samples`` are what is compared: offset, value, known. ``window`` is tried last.
    """
    position, turn, label = shown
    tried: list[tuple[ndarray, float]] = []
    for k, (site, offset, frame) in enumerate(zip(*near, strict=True)):
        if site < 0 or label[site] < 0 or (offset**2).sum() >= 2.5:
            continue
        source, angle = position[site], float(turn[site] - frame)
        texel = np.clip(np.floor(source + 0.5).astype(int), 0, np.array(similar.shape[:2]) - 1)
        alike = [source + (other - texel) for other in similar[tuple(texel)]] if k == 0 else []
        for guess, place in enumerate([source, *alike]):
            place = place - turned(offset, angle)
            whole = np.floor(place + 0.5).astype(int)
            inside = (whole >= 0).all() and (whole < usable.shape).all() and usable[tuple(whole)]
            fits = inside or k + guess == 0  # what is shown now may stay
            old = any(np.abs(place - other).sum() < 0.3 and np.cos(angle - its) > 0.87 for other, its in tried)
            if fits and len(tried) < most and not old:
                tried.append((place, angle))
    if window is not None:
        tried.append((window, 0.0))
    if not tried:
        return position[near[0][0]], float(turn[near[0][0]]), 0.0
    step, value, known = (part[samples[2] > 0] for part in samples)
    costs = []
    for place, angle in tried:
        squares = [
            ((bilinear(image, *(place + turned(s, angle))) - v) ** 2).sum() for s, v in zip(step, value, strict=True)
        ]
        costs.append(float(np.sum(squares) / max(len(known), 1)))
    best = int(np.argmin(costs))
    return *tried[best], costs[best]


def window_components(
    window: ndarray, known: ndarray, axes: ndarray, mean: ndarray, variance: ndarray, noise: float
) -> ndarray:
    """The likeliest components of a window (row, column, channel) of which some texels are known."""
    flat = axes.reshape(-1, axes.shape[-1]).astype(float)
    there = np.repeat(known.ravel(), window.shape[2]).astype(float)
    left = np.where(there > 0, (window - mean).ravel(), 0.0)
    if known.all():
        return flat.T @ left
    prior = np.diag(noise / np.maximum(variance.astype(float), 1e-3 * noise))
    return np.linalg.solve(flat.T @ (there[:, None] * flat) + prior, flat.T @ left)


def scan_pixel(
    image: ndarray,
    centre: ndarray,
    vectors: ndarray,
    query: ndarray,
    around: list[tuple[ndarray, ndarray]],
    suggested: list[int],
    shortlist: int,
) -> tuple[int, float]:
    """The candidate a pixel takes, and its mean squared difference to what is ``around`` it: (step, colour) each.

    The nearest window, or of a shortlist of them and what the neighbours suggest the one whose colours fit best.
    """
    distance = ((vectors - query) ** 2).sum(1)
    tried = np.argsort(distance, kind="stable")[:shortlist].tolist()
    if shortlist > 1:  # what is shown already comes first, so that it stays among equals
        tried = [guess for guess in suggested[4:] + suggested[:4] if guess >= 0] + tried
    costs = [sum(((image[tuple(centre[c] + step)] - colour) ** 2).sum() for step, colour in around) for c in tried]
    return tried[int(np.argmin(costs))], min(costs) / max(len(around), 1)
