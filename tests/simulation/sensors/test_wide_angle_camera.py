import math

import numpy as np
import pytest

from daidalos.description.errors import DescriptionError
from daidalos.samples.sensors import CameraInfoSample, ImageSample
from daidalos.simulation import Simulation
from simulation.models import world

FRAME = 34_000_000
GLOW = "<material><ambient>0 0 0 1</ambient><diffuse>0 0 0 1</diffuse><emissive>{0} 1</emissive></material>"


def camera(lens="", field=3.1, kind="wideanglecamera", size=(240, 180)):
    return (
        "<model name='robot'><static>true</static><pose>0 0 1 0 0 0</pose><link name='eye'>"
        f"<sensor name='cam' type='{kind}'><update_rate>30</update_rate><topic>eye/image</topic>"
        f"<camera><horizontal_fov>{field}</horizontal_fov>"
        f"<image><width>{size[0]}</width><height>{size[1]}</height></image>{lens}</camera></sensor></link></model>"
    )


def ball(angle, turn, color="1 0 0", distance=4.0):
    """Return a glowing ball at an angle off the camera's axis, turned about it from its left to above it."""
    x, off = distance * math.cos(angle), distance * math.sin(angle)
    return (
        f"<model name='ball'><static>true</static><pose>{x} {off * math.cos(turn)} {1 + off * math.sin(turn)} 0 0 0"
        "</pose><link name='l'><visual name='v'><geometry><sphere><radius>0.15</radius></sphere></geometry>"
        f"{GLOW.format(color)}</visual></link></model>"
    )


def samples(*parts, warn=None):
    simulation = Simulation(world(*parts), **({"warn": warn} if warn else {}))
    found = simulation.advance(FRAME)
    image = next(sample for sample in found if isinstance(sample, ImageSample))
    return image, next(sample for sample in found if isinstance(sample, CameraInfoSample))


def middle(pixels):
    """Return the column and row around which a picture is red."""
    red = (pixels[..., 0] > 150) & (pixels[..., 1] < 100)
    assert red.any()
    rows, columns = np.nonzero(red)
    return np.array((columns.mean(), rows.mean()))


@pytest.mark.parametrize(
    ("lens", "radius"),
    [
        ("<type>gnomonical</type>", None),
        ("<type>stereographic</type>", lambda angle, half: math.tan(angle / 2) / math.tan(half / 2)),
        ("<type>equidistant</type>", lambda angle, half: angle / half),
        ("<type>equisolid_angle</type>", lambda angle, half: math.sin(angle / 2) / math.sin(half / 2)),
        ("<type>orthographic</type>", lambda angle, half: math.sin(angle) / math.sin(half)),
        (
            "<type>custom</type><scale_to_hfov>false</scale_to_hfov><custom_function><c1>1.05</c1><c2>4</c2>"
            "<f>2.2</f><fun>tan</fun></custom_function>",
            lambda angle, half: 1.05 * 2.2 * math.tan(angle / 4),
        ),
    ],
)
def test_a_ball_is_seen_where_the_closed_form_of_the_lens_puts_it(lens, radius):
    field = 1.5 if radius is None else 3.1
    angle, turn = (0.5, 0.7) if radius is None else (1.1, 0.7)
    share = math.tan(angle) / math.tan(field / 2) if radius is None else radius(angle, field / 2)
    image, info = samples(ball(angle, turn), camera(f"<lens>{lens}<cutoff_angle>1.55</cutoff_angle></lens>", field))
    expected = np.array((120 - 120 * share * math.cos(turn), 90 - 120 * share * math.sin(turn)))
    assert np.abs(middle(image.pixels) - expected).max() < 0.8
    assert info.distortion_model == ("plumb_bob" if radius is None else "equidistant")
    assert info.matrix[0, 2] == 120


def test_a_fisheye_of_a_whole_turn_sees_behind_itself():
    lens = "<lens><type>equidistant</type><cutoff_angle>3.1416</cutoff_angle></lens>"
    image, info = samples(ball(2.6, 0.0), camera(lens, 6.2832, "wide_angle_camera"))
    assert middle(image.pixels) == pytest.approx((120 - 120 * 2.6 / math.pi, 90), abs=0.8)
    assert info.matrix[0, 0] == pytest.approx(120 / math.pi, rel=1e-4)
    assert np.allclose(info.distortion, 0)


def test_beyond_the_cutoff_angle_the_picture_is_black():
    image, _ = samples(camera("<lens><type>equidistant</type><cutoff_angle>0.775</cutoff_angle></lens>"))
    lit = image.pixels.any(axis=2)
    rows, columns = np.nonzero(lit)
    assert np.hypot(columns - 120, rows - 90).max() == pytest.approx(60, abs=1)
    assert lit[90, 61:180].all()


@pytest.mark.parametrize(
    ("lens", "message"),
    [
        ("<type>stereografic</type>", "<type> is 'stereografic'; did you mean 'stereographic'"),
        ("<type>custom</type><custom_function><fun>cos</fun></custom_function>", "<fun> is 'cos'.*sin, tan, id"),
        ("<type>custom</type><custom_function><c2>0</c2></custom_function>", "<c2> should be above 0"),
        ("<cutoff_angle>4</cutoff_angle>", "<cutoff_angle> should be above 0 and at most pi"),
        ("<env_texture_size>2</env_texture_size>", "<env_texture_size> should be between 4 and 2048"),
    ],
)
def test_mistakes_in_a_lens_are_told(lens, message):
    with pytest.raises(DescriptionError, match=message):
        Simulation(world(camera(f"<lens>{lens}</lens>")))


def test_a_lens_that_cannot_show_its_field_of_view_is_scaled_to_what_it_can():
    warnings = []
    image, _ = samples(ball(1.2, 0.0), camera("<lens><type>orthographic</type></lens>", 6.0), warn=warnings.append)
    assert any("orthographic" in line and "3.14 rad" in line for line in warnings)
    assert middle(image.pixels)[0] == pytest.approx(120 - 120 * math.sin(1.2), abs=0.8)
