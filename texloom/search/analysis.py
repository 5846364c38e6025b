"""All that is learnt from an exemplar before synthesis: done once, saved, and taken up again for the same pixels."""

import hashlib
import json
import os
import zipfile
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from jaxtyping import Float32, Int32

from texloom.errors import ExemplarError, FileError
from texloom.exemplar.appearance import appearance_vectors
from texloom.exemplar.exemplar import Exemplar
from texloom.exemplar.features import match_image
from texloom.exemplar.patches import PatchVectors, patch_vectors
from texloom.exemplar.pyramid import Level, gaussian_pyramid
from texloom.search.matching import Index, Search, State

VERSION = 1
"""Of saved analyses; raised whenever the same pixels would be analysed otherwise."""


@dataclass(frozen=True, eq=False)
class Analysis:
    """Match image and appearance vectors on every level, finest first, and the patch indices asked for so far."""

    fingerprint: str  # of the exemplar's pixels
    levels: Sequence[Level]  # of the match image
    appearance: Sequence[Float32[np.ndarray, "row column component"]]
    _indices: dict[str, tuple[PatchVectors, Index]] = field(default_factory=dict)
    _learnt: dict[str, State] = field(default_factory=dict)

    def index(
        self, search: Search, level: int, width: int, samples: Int32[np.ndarray, "sample 2"], *, step: int = 1
    ) -> tuple[PatchVectors, Index]:
        """The patches of a level in appearance space, and a search prepared on them; prepared once for each request."""
        request = _request(search, level, width, samples, step)
        if request not in self._indices:
            usable = self.levels[level].usable
            patches = patch_vectors(self.appearance[level], width, samples, step=step, usable=usable)
            learnt = self._learnt.get(request)
            index = search.prepare(patches.vectors) if learnt is None else search.restore(patches.vectors, learnt)
            self._indices[request] = patches, index
            self._learnt[request] = index.state()
        return self._indices[request]

    def save(self, path: str | Path) -> None:
        """Write to one file, whole or not at all."""
        path = Path(path)
        arrays, requests = self._arrays()
        header = {"texloom_analysis": VERSION, "fingerprint": self.fingerprint, "requests": requests}
        beside = path.with_name(path.name + ".part")
        try:
            with open(beside, "wb") as file:
                np.savez(file, allow_pickle=False, **arrays, header=np.array(json.dumps(header)))
            os.replace(beside, path)
        except OSError as error:
            raise FileError(f"{path} cannot be written: {error.strerror}") from error
        finally:
            beside.unlink(missing_ok=True)

    def _arrays(self) -> tuple[dict[str, np.ndarray], list[str]]:
        """Everything by a short name, and the requests in the order of their numbers."""
        arrays: dict[str, np.ndarray] = {}
        for number, (level, appearance) in enumerate(zip(self.levels, self.appearance, strict=True)):
            arrays[f"image{number}"], arrays[f"appearance{number}"] = level.image, appearance
            if level.usable is not None:
                arrays[f"usable{number}"] = level.usable
        for number, state in enumerate(self._learnt.values()):
            arrays |= {f"learnt{number}.{name}": values for name, values in state.items()}
        return arrays, list(self._learnt)


def analyse(exemplar: Exemplar, *, levels: int = 1, dimensions: int = 4, feature_weight: float = 0.5) -> Analysis:
    """Match image, its pyramid, and appearance vectors of each level (Chen, Liu & Dong, section 4.1)."""
    pyramid = gaussian_pyramid(match_image(exemplar), levels, usable=exemplar.mask)
    appearance = [
        appearance_vectors(level.image, dimensions=dimensions, feature_weight=feature_weight, usable=level.usable)
        for level in pyramid
    ]
    return Analysis(fingerprint(exemplar), pyramid, appearance)


def load_analysis(path: str | Path, exemplar: Exemplar) -> Analysis:
    """A saved analysis of this very exemplar.

    Raises: FileError, if the file is no analysis or of another version; ExemplarError, if it is of other pixels.
    """
    path = Path(path)
    try:
        with np.load(path, allow_pickle=False) as file:
            arrays = dict(file)
        header = json.loads(str(arrays.pop("header")))
        version = header["texloom_analysis"]
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile) as error:
        raise FileError(f"{path.name} is not a saved analysis: analyse the exemplar again") from error
    if version != VERSION:
        raise FileError(
            f"{path.name} is an analysis of version {version}, this Texloom reads {VERSION}: analyse the exemplar again"
        )
    if header["fingerprint"] != fingerprint(exemplar):
        raise ExemplarError(f"{path.name} is the analysis of other pixels than this exemplar's: analyse it again")
    return _from_arrays(header, arrays)


def fingerprint(exemplar: Exemplar) -> str:
    """A hash of every map's name, kind and values, and of the mask."""
    digest = hashlib.blake2b(digest_size=16)
    for name, m in exemplar.maps.items():
        digest.update(f"{name} {m.kind} {m.image.shape}".encode())
        digest.update(np.ascontiguousarray(m.image).data)
    if exemplar.mask is not None:
        digest.update(np.ascontiguousarray(exemplar.mask).data)
    return digest.hexdigest()


def _from_arrays(header: dict, arrays: dict[str, np.ndarray]) -> Analysis:
    """The inverse of ``Analysis._arrays``."""
    count = sum(name.startswith("image") for name in arrays)
    levels = [Level(arrays[f"image{i}"], arrays.get(f"usable{i}")) for i in range(count)]
    appearance = [arrays[f"appearance{i}"] for i in range(count)]
    learnt: dict[str, dict[str, np.ndarray]] = {request: {} for request in header["requests"]}
    for number, request in enumerate(header["requests"]):
        prefix = f"learnt{number}."
        learnt[request] = {name[len(prefix) :]: array for name, array in arrays.items() if name.startswith(prefix)}
    return Analysis(header["fingerprint"], levels, appearance, {}, dict(learnt))


def _request(search: Search, level: int, width: int, samples: Int32[np.ndarray, "sample 2"], step: int) -> str:
    """One name for all that an index depends on, besides the pixels."""
    offsets = hashlib.blake2b(np.ascontiguousarray(samples, np.int32).tobytes(), digest_size=8).hexdigest()
    return f"{search!r} level={level} width={width} samples={offsets} step={step}"
