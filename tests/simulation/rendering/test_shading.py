"""Sky and ambient light in the pictures of simulated cameras."""

import numpy as np

from daidalos.description import sdf
from daidalos.samples.sensors import ImageSample
from daidalos.simulation import Simulation

CAMERA = (
    "<model name='eye'><static>true</static><pose>0 0 5 0 0 0</pose><link name='l'><sensor name='cam' type='camera'>"
    "<update_rate>30</update_rate><camera><horizontal_fov>1.2</horizontal_fov><image><width>160</width>"
    "<height>120</height></image></camera></sensor></link></model>"
)
BALL = (
    "<model name='ball'><static>true</static><pose>3 0 5 0 0 0</pose><link name='l'><visual name='v'>"
    "<geometry><sphere><radius>1</radius></sphere></geometry><material><diffuse>0.8 0.8 0.8 1</diffuse></material>"
    "</visual></link></model>"
)


def picture(scene=""):
    """What a camera sees that looks level at a ball in the air, without any lamp."""
    simulation = Simulation(sdf.parse(f"<sdf version='1.9'><world name='w'>{scene}{CAMERA}{BALL}</world></sdf>"))
    (first, *_) = [sample for sample in simulation.advance(40_000_000) if isinstance(sample, ImageSample)]
    return first.pixels.astype(int)


def test_a_world_that_names_no_background_has_a_sky_that_is_lighter_at_the_horizon():
    seen = picture()
    above, horizon = seen[0, 5], seen[58, 5]
    assert horizon.sum() > above.sum() + 100
    assert above[2] > above[0] + 40, "it is blue"
    column = seen[:60, 5].sum(axis=1)
    assert np.all(np.abs(np.diff(column)) < 40), "without a step"


def test_a_world_has_the_background_that_it_names():
    seen = picture("<scene><background>0.2 0.4 0.6 1</background></scene>")
    assert seen[0, 5].tolist() == seen[58, 5].tolist() == [51, 102, 153]


def test_ambient_light_shapes_a_ball_that_no_lamp_lights():
    column = picture()[:, 80, 0]
    ball = column[30:90]
    assert ball[2] > ball[30] > ball[57]
    assert np.all(np.abs(np.diff(ball)) < 6), "softly"
