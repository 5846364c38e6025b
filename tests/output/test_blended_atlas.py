"""Faces on a sample, baked: the same picture as the sample on its UVs, also through a split mesh, also lit."""

import numpy as np
import pytest

from tests.output.quilted import thrown
from tests.output.shapes import grid_mesh, sphere
from texloom.exemplar.exemplar import Map
from texloom.mesh.refine import refine
from texloom.output.atlas import lay_atlas
from texloom.output.blended_atlas import bake_blend, face_sites
from texloom.output.blending import blend
from texloom.output.preview import Skin, preview
from texloom.output.sample_uv import on_sample
from texloom.output.tangents import corner_tangents
from texloom.output.unwrap import unwrap

SHAPE = (48, 64)


def smooth(seed, channels=3):
    """A soft random picture, so that resampling hardly matters."""
    from scipy.ndimage import gaussian_filter

    rough = np.random.default_rng(seed).random((*SHAPE, channels))
    soft = gaussian_filter(rough, (2.5, 2.5, 0))
    return ((soft - soft.min()) / np.ptp(soft)).astype(np.float32)


def bumps(seed):
    vectors = np.concatenate([2 * smooth(seed, 2) - 1, np.full((*SHAPE, 1), 0.8)], axis=2)
    vectors /= np.linalg.norm(vectors, axis=2, keepdims=True)
    return Map((0.5 * vectors + 0.5).astype(np.float32), "normal", 8)


def atlas_of(mesh, coordinates, size=512):
    uv = unwrap(mesh, size=size)
    tangents = corner_tangents(mesh.vertices, mesh.faces, uv, normals=mesh.vertex_normals[mesh.faces])
    return lay_atlas(face_sites(mesh, coordinates), uv, size=size, tangents=tangents), uv, tangents


@pytest.mark.parametrize("lit", [False, True])
def test_the_sample_on_its_uvs_looks_like_its_atlas(lit):
    """Two ways to one picture; lit by a normal map too, so that both tangent frames mean the same."""
    mesh = sphere(6)
    coordinates = thrown(mesh, SHAPE, texel=0.04)
    colour = Map(np.full((*SHAPE, 3), 0.5, np.float32) if lit else smooth(1), "colour", 8)
    maps = {"basecolor": colour, **({"normal": bumps(2)} if lit else {})}
    on = on_sample(mesh, coordinates, SHAPE)
    atlas, uv, tangents = atlas_of(mesh, coordinates)
    baked = bake_blend(blend(mesh, coordinates), atlas, maps)

    def shown(maps, uv, tangents):
        normal = maps["normal"].image if lit else None
        skin = Skin(texture=maps["basecolor"].image, uv=uv, bumps=normal, tangents=tangents, gloss=0.0)
        picture = preview(mesh.vertices, mesh.faces, skin, normals=mesh.vertex_normals, size=160, views=2)
        return picture.astype(int)

    direct, through = shown(maps, on.uv, on.tangents), shown(baked, uv, tangents)
    apart = np.abs(direct - through)
    plain = preview(
        mesh.vertices, mesh.faces, Skin(colours=np.full((len(mesh.vertices), 3), 0.5)),
        normals=mesh.vertex_normals, size=160, views=2,
    )  # fmt: skip
    assert apart.mean() < 0.6 and np.percentile(apart, 97) <= 6
    assert np.abs(direct - plain.astype(int)).mean() > 5  # there is something to see


def test_a_split_mesh_bakes_onto_the_users_faces():
    mesh = grid_mesh(2, 1.0)[0]
    coordinates = thrown(mesh, SHAPE, texel=0.03)
    uv = (mesh.vertices[mesh.faces][..., :2] * 0.9 + 0.05).astype(np.float32)
    maps = {"a": Map(smooth(4), "data", 8)}
    whole = bake_blend(blend(mesh, coordinates), lay_atlas(face_sites(mesh, coordinates), uv, size=64), maps)
    fine = refine(mesh, 0.2)
    inner = np.einsum("fcp,fpn->fcn", fine.corner_barycentric, coordinates[fine.parent])
    sites = face_sites(fine.mesh, inner, parent=fine.parent, corners=fine.corner_barycentric)
    split = bake_blend(blend(fine.mesh, inner), lay_atlas(sites, uv, size=64), maps)
    apart = np.abs(whole["a"].image - split["a"].image)
    assert len(fine.mesh.faces) > 4 * len(mesh.faces)
    assert (apart.max(axis=2) > 0.01).mean() < 0.05  # texels whose centre lies on an edge may go to either side


def test_the_blended_atlas_differs_along_blended_edges_only():
    mesh = grid_mesh(1)[0]
    coordinates = thrown(mesh, SHAPE, texel=0.03)
    uv = mesh.vertices[mesh.faces][..., :2].astype(np.float32)
    atlas = lay_atlas(face_sites(mesh, coordinates), uv, size=64, gutter=0)
    maps = {"a": Map(smooth(5), "data", 8)}
    plain = bake_blend(blend(mesh, coordinates), atlas, maps)["a"].image
    soft = bake_blend(blend(mesh, coordinates, np.ones((2, 3), bool)), atlas, maps)["a"].image
    row, column = np.mgrid[:64, :64]
    to_edge = np.abs(column - (63 - row))  # the one inner edge runs from the lower left to the upper right
    changed = np.abs(soft - plain).max(axis=2) > 1e-6
    assert changed[to_edge < 10].mean() > 0.8 and not changed[to_edge > 34].any()

    def step(image):
        one, other = image[row == 63 - column][8:-9], image[row == 62 - column][8:-8]
        return np.abs(one - other).mean()

    assert step(soft) < 0.5 * step(plain)
