"""The search of triangle quilting once more, in plain NumPy: strings, votes over the whole sample, and eq. 2."""

from dataclasses import dataclass

import numpy as np
from numpy import ndarray

from tests.naive import bilinear
from texloom.domain.faces import Faces
from texloom.search.textons import Textons


@dataclass(frozen=True)
class String:
    """What the neighbours of a patch show along its rim."""

    texton: ndarray  # (point,)
    row: ndarray  # (point,) offset from the patch's place
    column: ndarray
    wanted: ndarray  # (point, channel)

    def __len__(self) -> int:
        return len(self.texton)


@dataclass(frozen=True)
class Slow:
    """A sample and the patches to place in it. Places are complex numbers, column + 1j * row."""

    textons: Textons
    faces: Faces

    def turn(self, branch: int) -> complex:
        """One of the field's symmetries."""
        return np.exp(2j * np.pi * branch / self.faces.order)

    def corners(self, p: int, branch: int) -> ndarray:
        """Of a patch, about its place."""
        return self.turn(branch) * self.faces.layout[self.faces.patch == p].astype(complex).ravel()

    def string(self, p: int, branch: int, place: ndarray, branches: ndarray) -> String:
        """Walk the rim: per texel of the longer component a point, where the neighbour's map is continued."""
        layout, twins = self.faces.layout.astype(complex), self.faces.mesh.twins
        labels = self.textons.labels
        orientations, rows, columns = labels.shape
        points = []
        for j in range(self.faces.rim[0][p], self.faces.rim[0][p + 1]):
            h = self.faces.rim[1][j]
            t = twins[h]
            q = self.faces.patch[t // 3]
            if branches[q] < 0:
                continue
            own = [self.turn(branch) * layout[h // 3, c % 3] for c in (h, h + 1 if h % 3 < 2 else h - 2)]
            there = [
                place[q] + self.turn(branches[q]) * layout[t // 3, c % 3] for c in (t + 1 if t % 3 < 2 else t - 2, t)
            ]
            ratio = (there[1] - there[0]) / (own[1] - own[0])
            shown = labels[round(np.angle(ratio) * orientations / (2 * np.pi)) % orientations]
            along = own[1] - own[0]
            count = max(int(np.ceil(max(abs(along.real), abs(along.imag)))), 1)
            for k in range(count):
                at = own[0] + (k + 0.5) / count * along
                whole = complex(nearest(at.real), nearest(at.imag))
                source = there[0] + ratio * (whole - own[0])
                r, c = (
                    int(np.clip(np.floor(v + 0.5), 0, n - 1)) for v, n in ((source.imag, rows), (source.real, columns))
                )
                if shown[r, c] >= 0:
                    wanted = bilinear(self.textons.image, source.imag, source.real)
                    points.append((shown[r, c], int(whole.imag), int(whole.real), wanted))
        if not points:
            return String(*np.zeros((3, 0), int), np.zeros((0, self.textons.image.shape[2])))
        return String(*(np.array(column) for column in zip(*points, strict=True)))

    def room(self, p: int, branch: int) -> ndarray:
        """(row, column) whether the patch may be placed at a whole texel."""
        rows, columns = self.textons.exemplar.shape
        corners = self.corners(p, branch)
        room = np.zeros((rows, columns), bool)
        top, bottom = int(np.floor(corners.imag.min() + 1e-4)), int(np.ceil(corners.imag.max() - 1e-4))
        left, right = int(np.floor(corners.real.min() + 1e-4)), int(np.ceil(corners.real.max() - 1e-4))
        for r in range(-top, rows - bottom):
            for c in range(-left, columns - right):
                room[r, c] = self.textons.exemplar.usable[r + top : r + bottom + 1, c + left : c + right + 1].all()
        return room

    def votes(self, string: String, thin: int = 1) -> ndarray:
        """N[x] of the paper: points whose texton the sample has there."""
        rows, columns = self.textons.exemplar.shape
        labels = self.textons.labels[0]
        count = np.zeros((rows, columns), int)
        for t, dr, dc in list(zip(string.texton, string.row, string.column, strict=True))[::thin]:
            r, c = np.nonzero(labels == t)
            inside = (r - dr >= 0) & (r - dr < rows) & (c - dc >= 0) & (c - dc < columns)
            count[r[inside] - dr, c[inside] - dc] += 1
        return count

    def errors(self, string: String, room: ndarray) -> ndarray:
        """E[x] of eq. 2 at every whole place with room; infinite elsewhere."""
        error = np.full(room.shape, np.inf)
        r, c = np.nonzero(room)
        labels = self.textons.labels[0][r[:, None] + string.row, c[:, None] + string.column]
        assert (labels >= 0).all()
        error[r, c] = self.textons.distance[string.texton, labels].sum(1)
        return error

    def error_between(self, place: complex, string: String, share: float) -> float:
        """Differences of colour, and ``share`` of those of the textons, at any place."""
        rows, columns = self.textons.exemplar.shape
        total = 0.0
        for t, dr, dc, wanted in zip(string.texton, string.row, string.column, string.wanted, strict=True):
            r, c = place.imag + dr, place.real + dc
            near = tuple(int(np.clip(np.floor(v + 0.5), 0, n - 1)) for v, n in ((r, rows), (c, columns)))
            label = self.textons.labels[0][near]
            total += 1e6 if label < 0 else share * np.sqrt(self.textons.distance[t, label])
            total += np.sqrt(((bilinear(self.textons.image, r, c) - wanted) ** 2).sum())
        return total

    def continuations(self, p: int, branch: int, place: ndarray, branches: ndarray) -> list[complex]:
        """Places of a patch at which an edge's middle is where a neighbour has it."""
        layout, twins, patch = self.faces.layout.astype(complex), self.faces.mesh.twins, self.faces.patch
        found = []
        for j in range(self.faces.rim[0][p], self.faces.rim[0][p + 1]):
            h = self.faces.rim[1][j]
            f, g = h // 3, twins[h] // 3
            if branches[patch[g]] >= 0:
                shared = np.isin(self.faces.mesh.faces[f], self.faces.mesh.faces[[g]][0])
                beyond = np.isin(self.faces.mesh.faces[g], self.faces.mesh.faces[[f]][0])
                if shared.sum() == beyond.sum() == 2:
                    middle = place[patch[g]] + self.turn(branches[patch[g]]) * layout[g][beyond].mean()
                    found.append(middle - self.turn(branch) * layout[f][shared].mean())
        return found


def nearest(value: float) -> float:
    """The nearest whole number; of two the one farther from 0."""
    return float(np.copysign(np.floor(abs(value) + 0.5), value))


def bound(votes: ndarray, errors: ndarray, candidates: int) -> tuple[float, int]:
    """The least error any choice of the most voted is sure to have, and the votes that the last of them has.

    Those with more votes than the last all compete; of those with as many it is open which. Places without votes
    do not. Infinite where nothing has votes.
    """
    errors, votes = errors[np.isfinite(errors)], votes[np.isfinite(errors)]
    voted = np.sort(votes[votes > 0])[::-1]
    if len(voted) == 0:
        return np.inf, 0
    last = int(voted[min(candidates, len(voted)) - 1])
    above, equal = errors[votes > last], np.sort(errors[votes == last])
    left_out = max(len(equal) - (candidates - len(above)), 0)
    return min(above.min(initial=np.inf), equal[left_out]), last
