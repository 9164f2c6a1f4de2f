from daidalos.common.kernels import warm_up
from daidalos.simulation.rendering import image_effects, sunlight
from daidalos.simulation.rendering.flat_raster import draw_flat
from daidalos.simulation.rendering.raster import draw, place_parts
from daidalos.simulation.rendering.shading import shade


def test_every_loop_that_a_camera_calls_is_compiled():
    warm_up("daidalos.simulation.rendering")
    lenses = (image_effects.distort, image_effects.pick, image_effects.mosaic, image_effects.add_noise)
    for kernel in (draw, draw_flat, place_parts, shade, sunlight.coarsen, *lenses):
        assert kernel.signatures, kernel
