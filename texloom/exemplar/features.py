"""What matching compares: one image of a few channels in which every map of the stack has its say."""

from collections.abc import Iterator

import numpy as np
from jaxtyping import Float32

from texloom.arrays import Image
from texloom.exemplar.colour import encode
from texloom.exemplar.exemplar import Exemplar, Map
from texloom.exemplar.pca import fit

# Share of the lead map's variance that each further map gets: relief draws the structure, the rest follows it.
_SHARE = {"height": 0.5, "normal": 0.5, "alpha": 0.5, "roughness": 0.25, "metallic": 0.25, "ao": 0.1}
_OTHER_SHARE = 0.25
_MOST_FURTHER_CHANNELS = 3  # of all further maps together, by PCA: matching time grows with channels
_FLAT = 1.5 / 255  # standard deviation under which a map is noise of its storage and has no say


def match_image(exemplar: Exemplar) -> Image:
    """The lead map as the eye sees it (encoded sRGB) and up to three channels of the further maps.

    Further maps are scaled to shares of the lead's variance over the usable texels, so that a brick edge counts
    whether it shows in colour, in height or in both. Units are those of the lead: [0, 1].
    """
    lead = visible(exemplar.lead)
    further = list(_further_channels(exemplar, _energy(lead, exemplar)))
    if not further:
        return lead
    stacked = np.concatenate(further, axis=2)
    if stacked.shape[2] > _MOST_FURTHER_CHANNELS:
        texels = stacked.reshape(-1, stacked.shape[2])
        projection = fit(texels[exemplar.usable.ravel()], _MOST_FURTHER_CHANNELS)
        stacked = projection(texels).reshape(*exemplar.shape, -1)
    return np.concatenate([lead, stacked], axis=2)


def visible(m: Map) -> Image:
    """A map as matching reads it: colours encoded, of normals the two components in the plane, data as it is."""
    if m.kind == "colour":
        return encode(m.image) if m.bits != 32 else _encode_high_range(m.image)
    return np.ascontiguousarray(m.image[..., :2]) if m.kind == "normal" else m.image


def _further_channels(exemplar: Exemplar, lead_energy: float) -> Iterator[Image]:
    """Every map but the lead that is not flat, scaled to its share of the lead's variance."""
    reference = max(lead_energy, _FLAT**2)
    for name, m in list(exemplar.maps.items())[1:]:
        image = visible(m)
        energy = _energy(image, exemplar)
        if energy > _FLAT**2:
            yield image * np.float32(np.sqrt(_SHARE.get(name, _OTHER_SHARE) * reference / energy))


def _energy(image: Image, exemplar: Exemplar) -> float:
    """Variance over the usable texels, summed over channels."""
    texels = image.reshape(-1, image.shape[2]) if exemplar.mask is None else image[exemplar.mask]
    return float(texels.var(axis=0, dtype=np.float64).sum())


def _encode_high_range(linear: Float32[np.ndarray, "*shape"]) -> Float32[np.ndarray, "*shape"]:
    """Encoded light that may exceed 1: scaled so that all but the brightest hundredth fits."""
    bright = float(np.percentile(linear, 99))
    return encode(linear / np.float32(bright) if bright > 1.0 else linear)
