import numpy as np

from daidalos.simulation.rendering.textures import make_atlas, mip_chain


def test_levels_are_means_down_to_one_texel():
    image = np.random.default_rng(2).integers(0, 255, (8, 8, 4)).astype(np.uint8)
    chain = mip_chain(image)
    assert [level.shape[:2] for level in chain] == [(8, 8), (4, 4), (2, 2), (1, 1)]
    wanted = image.astype(float).reshape(4, 2, 4, 2, 4).mean(axis=(1, 3))
    assert np.abs(chain[1] - wanted).max() <= 0.5


def test_odd_sizes_end_at_one_texel():
    assert mip_chain(np.full((5, 3, 4), 7, dtype=np.uint8))[-1].tolist() == [[[7, 7, 7, 7]]]


def test_an_atlas_finds_every_texture():
    images = [np.full((4, 2, 4), value, dtype=np.uint8) for value in (10, 20)]
    atlas = make_atlas(images)
    for (first, count), image in zip(atlas.textures, images, strict=True):
        place, width, height = atlas.levels[first]
        assert (width, height) == (2, 4)
        assert (atlas.texels[place : place + 8] == image[0, 0]).all()
        assert count == 3


def test_an_atlas_may_be_empty():
    assert len(make_atlas([]).textures) == 0
