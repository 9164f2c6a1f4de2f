from daidalos.simulation.rendering import film, sunlight, warming
from daidalos.simulation.rendering.flat_raster import draw_flat
from daidalos.simulation.rendering.raster import draw, place_parts
from daidalos.simulation.rendering.shading import shade


def test_every_loop_that_a_camera_calls_is_compiled():
    steps = []
    warming.warm_up(lambda share, step: steps.append(share))
    assert steps == sorted(steps)
    assert steps[-1] == 1.0
    for kernel in (draw, draw_flat, place_parts, shade, film.bend, film.pick, film.add_noise, sunlight.coarsen):
        assert kernel.signatures, kernel
