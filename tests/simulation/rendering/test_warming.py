from daidalos.simulation.rendering import film, raster, shading, warming
from daidalos.simulation.rendering.raster import draw, draw_flat, place_parts
from daidalos.simulation.rendering.shading import shade


def test_every_loop_that_a_camera_calls_is_compiled():
    steps = []
    warming.warm_up(lambda share, step: steps.append(share))
    assert steps == sorted(steps)
    assert steps[-1] == 1.0
    for kernel in (draw, draw_flat, place_parts, shade, film.bend, film.pick, film.add_noise, shading.coarsen):
        assert kernel.signatures, kernel
    assert raster
