import cv2
import numpy as np
import pytest

from daidalos.description.errors import DescriptionError
from daidalos.samples.sensors import (
    CameraInfoSample,
    ImageSample,
    LogicalImageSample,
    PointCloudSample,
)
from daidalos.simulation import Simulation
from simulation.models import box, world

SUN = "<include><uri>model://sun</uri></include>"
FRAME = 34_000_000


def camera(kind="camera", extra="", more="", size=(640, 480), pose="0 0 1 0 0 0", inside=""):
    width, height = size
    return (
        f"<model name='robot'><static>true</static><pose>{pose}</pose><link name='eye'>"
        f"<sensor name='cam' type='{kind}'>"
        f"<update_rate>30</update_rate>{more}<camera name='left'><horizontal_fov>1.047</horizontal_fov>"
        f"<image><width>{width}</width><height>{height}</height>{inside}</image>{extra}</camera></sensor></link></model>"
    )


def thing(name, pose, shape, color="1 1 1 1", texture="", extra=""):
    look = (
        f"<pbr><metal><albedo_map>{texture}</albedo_map></metal></pbr>"
        if texture
        else (f"<ambient>{color}</ambient><diffuse>{color}</diffuse>")
    )
    return (
        f"<model name='{name}'><static>true</static><pose>{pose}</pose><link name='l'><visual name='v'>"
        f"<geometry>{shape}</geometry><material>{look}</material>{extra}</visual></link></model>"
    )


def samples(*parts, duration=FRAME, **kwargs):
    return Simulation(world(*parts), **kwargs).advance(duration)


def image(found, ending="image"):
    return next(s for s in found if isinstance(s, ImageSample) and s.topic.endswith(ending))


BALL = "<sphere><radius>0.2</radius></sphere>"
BOARD = "<box><size>0.02 {0} {1}</size></box>"


def test_opencv_finds_an_aruco_tag_and_where_it_is(tmp_path):
    dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50)
    tag = np.pad(cv2.aruco.generateImageMarker(dictionary, 7, 400), 80, constant_values=255)
    cv2.imwrite(str(tmp_path / "tag.png"), tag)
    board = thing("tag", "2 0.3 1 0 0 0.3", BOARD.format(0.42, 0.42), texture=tmp_path / "tag.png")
    found = samples(SUN, board, camera())
    seen = image(found).pixels
    parameters = cv2.aruco.DetectorParameters()
    parameters.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_SUBPIX
    corners, numbers, _ = cv2.aruco.ArucoDetector(dictionary, parameters).detectMarkers(seen)
    assert numbers.ravel().tolist() == [7]
    info = next(s for s in found if isinstance(s, CameraInfoSample))
    half = 0.15
    square = np.array([(-half, half, 0), (half, half, 0), (half, -half, 0), (-half, -half, 0)])
    _, _, place = cv2.solvePnP(square, corners[0][0], info.matrix, np.zeros(5), flags=cv2.SOLVEPNP_IPPE_SQUARE)
    # In the optical frame: the board's near face, 1 cm before its centre.
    assert place.ravel() == pytest.approx((-0.3, 0.0, 2.0 - 0.01), abs=0.02)


@pytest.mark.parametrize(("distance", "yaw"), [(1.0, 0.0), (1.6, -0.4), (2.5, 0.6)])
def test_opencv_finds_a_chessboard(tmp_path, distance, yaw):
    squares = np.kron(np.indices((7, 10)).sum(axis=0) % 2, np.ones((60, 60))) * 255
    cv2.imwrite(str(tmp_path / "board.png"), np.pad(squares, 60, constant_values=255).astype(np.uint8))
    board = thing("board", f"-{distance} 0 1 0 -0.3 {yaw}", BOARD.format(0.72, 0.54), texture=tmp_path / "board.png")
    facing_the_sunny_side = camera(pose="0 0 1 0 0 3.141592653589793")
    seen = cv2.cvtColor(image(samples(SUN, board, facing_the_sunny_side)).pixels, cv2.COLOR_RGB2GRAY)
    found, corners = cv2.findChessboardCorners(seen, (9, 6))
    assert found
    assert len(corners) == 54


def test_a_balls_colour_is_right():
    seen = image(samples(SUN, thing("ball", "2 0 1 0 0 0", BALL, "0.9 0.1 0.05 1"), camera())).pixels
    inside = seen[200:280, 285:355].reshape(-1, 3)
    hue = cv2.cvtColor(inside[None], cv2.COLOR_RGB2HSV)[0, :, 0].astype(int)
    assert np.all((hue < 8) | (hue > 172))
    assert (inside[:, 0] > 3 * inside[:, 1]).all()
    centre, radius = cv2.minEnclosingCircle(
        np.argwhere(seen[:, :, 0] > 2.5 * seen[:, :, 1])[:, ::-1].astype(np.float32)
    )
    focal = 320 / np.tan(0.5235)
    assert centre == pytest.approx((320, 240), abs=1.5)
    assert radius == pytest.approx(focal * np.tan(np.arcsin(0.1)), abs=1.5)


def test_depths_are_those_of_rays():
    parts = (thing("wall", "3 0 1 0 0 0.5", "<box><size>0.1 9 9</size></box>"), camera("depth_camera", size=(64, 48)))
    found = samples(*parts)
    depth = image(found, "depth_image")
    assert depth.encoding == "32FC1"
    yaw, u = 0.5, np.arange(64)
    focal = 32 / np.tan(0.5235)
    slope = -(u - 32) / focal
    # The near face of a wall through (3, 0) that is turned: n . p = n . (3, 0) - 0.05 with n towards the camera.
    normal = np.array((np.cos(yaw), np.sin(yaw)))
    wanted = (3 * normal[0] - 0.05) / (normal[0] + slope * normal[1])
    assert depth.pixels[10] == pytest.approx(wanted, rel=1e-4)
    cloud = next(s for s in found if isinstance(s, PointCloudSample))
    assert cloud.points[10, :, 0] == pytest.approx(wanted, rel=1e-4)  # x ahead
    assert cloud.points[10, :, 1] == pytest.approx(wanted * slope, rel=1e-3, abs=1e-5)


def test_nothing_in_reach_is_infinitely_far_and_no_point():
    found = samples(camera("rgbd_camera", "<clip><near>0.1</near><far>5</far></clip>", size=(32, 24)))
    assert np.isposinf(image(found, "depth_image").pixels[:10]).all()
    assert np.isnan(next(s for s in found if isinstance(s, PointCloudSample)).points[:10]).all()


def test_topics_and_frames_are_gzs():
    topics = {s.topic for s in samples(camera("rgbd_camera", more="<topic>rgbd</topic>", size=(8, 8)))}
    assert topics == {"/rgbd/image", "/rgbd/depth_image", "/rgbd/points", "/rgbd/camera_info"}
    topics = {s.topic for s in samples(camera("depth_camera", more="<topic>deep</topic>", size=(8, 8)))}
    assert topics == {"/deep", "/deep/points", "/camera_info"}
    more = "<topic>front/image</topic><gz_frame_id>optical</gz_frame_id>"
    found = samples(camera(more=more, size=(8, 8)))
    assert {(s.topic, s.frame_id) for s in found} == {("/front/image", "optical"), ("/front/camera_info", "optical")}


def test_nobody_listens_nobody_draws():
    simulation = Simulation(world(camera()), has_subscribers=lambda topic: topic.endswith("camera_info"))
    assert [type(s) for s in simulation.advance(FRAME)] == [CameraInfoSample]


def test_pictures_are_dropped_where_there_is_no_time():
    asked = []

    def can_draw(topic, now_ns):
        asked.append((topic, now_ns))
        return len(asked) % 2 == 0

    simulation = Simulation(world(camera(size=(8, 8))), can_draw=can_draw)
    drawn = [s.stamp_ns for s in simulation.advance(4 * FRAME + 1_000_000) if isinstance(s, ImageSample)]
    assert [topic for topic, _ in asked] == ["/robot/eye/cam/image"] * 4
    assert drawn == [now_ns for _, now_ns in asked[1::2]]


PLUGIN = "<plugin name='p' filename='lib{}.so'>{}</plugin>"


def test_the_ros2_plugin_names_topics():
    more = PLUGIN.format(
        "gazebo_ros_camera",
        "<ros><namespace>bot</namespace><remapping>image_raw:=picture</remapping></ros>"
        "<camera_name>head</camera_name><frame_name>head_optical</frame_name>",
    )
    found = samples(camera(more=more, size=(8, 8)))
    assert {s.topic for s in found} == {"/bot/picture", "/bot/head/camera_info"}
    assert {s.frame_id for s in found} == {"head_optical"}


def test_the_ros2_plugin_of_a_depth_camera_speaks_optically():
    more = PLUGIN.format("gazebo_ros_camera", "<camera_name>d</camera_name><max_depth>2.5</max_depth>")
    wall = thing("wall", "2 0 1 0 0 0", "<box><size>0.1 9 9</size></box>")
    found = samples(wall, camera("depth", more=more, size=(16, 12)))
    assert {s.topic for s in found} == {
        *("/d/image_raw", "/d/camera_info", "/d/depth/image_raw", "/d/depth/camera_info", "/d/points")
    }
    cloud = next(s for s in found if isinstance(s, PointCloudSample))
    assert cloud.points[6, 8] == pytest.approx((0, 0, 1.95), abs=1e-3)
    assert cloud.colors.shape == (12, 16, 3)


def test_ros1s_plugin_names_topics_too():
    more = PLUGIN.format(
        "gazebo_ros_openni_kinect",
        "<cameraName>k</cameraName><imageTopicName>rgb/image_raw</imageTopicName>"
        "<depthImageTopicName>depth/image_raw</depthImageTopicName><pointCloudTopicName>depth/points</pointCloudTopicName>"
        "<cameraInfoTopicName>rgb/camera_info</cameraInfoTopicName><frameName>k_optical</frameName>",
    )
    topics = {s.topic for s in samples(camera("depth", more=more, size=(8, 8)))}
    assert topics == {
        *("/k/rgb/image_raw", "/k/rgb/camera_info", "/k/depth/image_raw", "/k/depth/camera_info", "/k/depth/points")
    }


def test_a_stereo_pair_sees_the_disparity_that_its_projections_tell():
    second = (
        "<camera name='right'><pose>0 -0.1 0 0 0 0</pose><horizontal_fov>1.047</horizontal_fov>"
        "<image><width>320</width><height>240</height></image></camera></sensor>"
    )
    text = camera("multicamera", size=(320, 240)).replace("</sensor>", second)
    found = samples(SUN, thing("ball", "2 0 1 0 0 0", BALL, "1 0 0 1"), text)
    columns = []
    for side in ("left", "right"):
        red = image(found, f"{side}/image").pixels.astype(int)
        columns.append(np.argwhere(red[:, :, 0] > 2 * red[:, :, 1] + 20)[:, 1].mean())
    info = next(s for s in found if isinstance(s, CameraInfoSample) and "right" in s.topic)
    assert info.projection[0, 3] == pytest.approx(-info.matrix[0, 0] * 0.1)
    assert columns[0] - columns[1] == pytest.approx(info.matrix[0, 0] * 0.1 / 2.0, rel=0.05)


def test_the_left_eye_of_a_stereo_pair_is_the_one_that_distances_are_told_from():
    second = "<camera name='right'><image><width>8</width><height>8</height></image></camera></sensor>"
    plugin = PLUGIN.format("gazebo_ros_camera", "<hack_baseline>0.07</hack_baseline>")
    text = camera("multicamera", size=(8, 8), more=plugin).replace("</sensor>", second)
    left, right = (s for s in samples(text) if isinstance(s, CameraInfoSample))
    assert left.projection[0, 3] == 0.0
    assert right.projection[0, 3] == pytest.approx(-right.matrix[0, 0] * 0.07)


def test_a_depth_camera_may_name_its_format():
    wall = thing("wall", "2 0 1 0 0 0", "<box><size>0.1 9 9</size></box>")
    depths = samples(wall, camera("depth_camera", size=(8, 6), inside="<format>R_FLOAT32</format>"))
    assert image(depths).encoding == "32FC1"


@pytest.mark.slow
def test_a_segmentation_camera_tells_classes_and_instances():
    label = "<plugin filename='gz-sim-label-system' name='l'><label>{}</label></plugin>"
    parts = [
        thing(f"t{n}", f"2 {y} 1 0 0 0", BALL, extra=label.format(number))
        for n, (y, number) in enumerate(((0.5, 40), (-0.5, 40), (0.0, 9)))
    ]
    extra = "<segmentation_type>panoptic</segmentation_type>"
    found = samples(*parts, camera("segmentation_camera", extra))
    seen = image(found, "labels_map").pixels
    focal = 320 / np.tan(0.5235)
    middle = [seen[240, int(320 - focal * y / 2)].tolist() for y in (0.5, -0.5, 0.0)]
    assert middle == [[1, 0, 40], [2, 0, 40], [1, 0, 9]]
    assert seen[20, 20].tolist() == [0, 0, 0]
    assert len(np.unique(image(found, "colored_map").pixels.reshape(-1, 3), axis=0)) == 4


def test_a_logical_camera_lists_what_reaches_into_its_view():
    eye = (
        "<model name='robot'><static>true</static><pose>0 0 0.5 0 0 0</pose><link name='eye'>"
        "<sensor name='cam' type='logical_camera'><update_rate>30</update_rate><logical_camera><near>0.1</near>"
        "<far>5</far><horizontal_fov>1.0</horizontal_fov><aspect_ratio>1</aspect_ratio></logical_camera></sensor>"
        "</link></model>"
    )
    found = samples(eye, box("ahead", "3 0.5 0.5 0 0 0"), box("behind", "-3 0 0.5 0 0 0"), box("far", "9 0 0.5 0 0 0"))
    (seen,) = [s for s in found if isinstance(s, LogicalImageSample)]
    assert [name for name, _ in seen.models] == ["ahead"]
    assert seen.models[0][1].position == pytest.approx((3, 0.5, 0), abs=1e-3)


def test_noise_has_the_spread_that_was_asked_for():
    noise = "<noise><type>gaussian</type><mean>0</mean><stddev>0.02</stddev></noise>"
    floor = thing("wall", "2 0 1 0 0 0", "<box><size>0.1 9 9</size></box>", "1 1 1 1")
    seen = image(samples(floor, camera(extra=noise))).pixels.astype(float)
    assert seen.std() == pytest.approx(0.02 * 255, rel=0.05)
    assert np.corrcoef(seen[:, :-1].ravel(), seen[:, 1:].ravel())[0, 1] == pytest.approx(0, abs=0.01)


@pytest.mark.slow
def test_a_lens_bends_straight_lines_as_opencv_undoes_it():
    squares = thing("ball", "2 0.6 1.4 0 0 0", BALL, "1 0 0 1")
    bent = "<distortion><k1>-0.25</k1><k2>0.06</k2><p1>0.001</p1><p2>0.002</p2><center>0.5 0.5</center></distortion>"
    straight, curved = (samples(squares, camera(extra=extra)) for extra in ("", bent))
    info = next(s for s in curved if isinstance(s, CameraInfoSample))
    undone = cv2.undistort(image(curved).pixels, info.matrix, np.array(info.distortion))
    pictures = (image(straight).pixels, image(curved).pixels, undone)
    red = [np.argwhere(p[:, :, 0] > 2.0 * p[:, :, 1] + 20).mean(axis=0) for p in pictures]
    assert np.abs(red[0] - red[1]).max() > 5
    assert red[2] == pytest.approx(red[0], abs=0.3)


@pytest.mark.parametrize(
    ("name", "encoding", "bands"),
    [("B8G8R8", "bgr8", 3), ("L8", "mono8", 0), ("L16", "mono16", 0), ("BAYER_RGGB8", "bayer_rggb8", 0)],
)
def test_formats_have_ros_names(name, encoding, bands):
    ball = thing("wall", "2 0 1 0 0 0", "<box><size>0.1 9 9</size></box>", "1 0.5 0 1")
    found = image(samples(ball, camera(size=(8, 6), inside=f"<format>{name}</format>")))
    assert found.encoding == encoding
    assert found.pixels.shape == ((6, 8, bands) if bands else (6, 8))
    color = round(0.4 * 255), round(0.2 * 255), 0
    if encoding == "bgr8":
        assert found.pixels[0, 0].tolist() == list(color[::-1])
    elif encoding == "mono8":
        assert found.pixels[0, 0] == round(0.299 * color[0] + 0.587 * color[1])
    elif encoding.startswith("bayer"):
        assert found.pixels[:2, :2].tolist() == [[color[0], color[1]], [color[1], color[2]]]


@pytest.mark.parametrize(
    ("extra", "inside", "words"),
    [
        ("<clip><near>2</near><far>1</far></clip>", "", "0 < near < far"),
        ("", "<format>JPEG</format>", "'JPEG', expected one of"),
        ("<lens><intrinsics><fx>a</fx></intrinsics></lens>", "", "fx"),
    ],
)
def test_nonsense_is_named(extra, inside, words):
    with pytest.raises(DescriptionError, match=words):
        Simulation(world(camera(extra=extra, inside=inside)))


def test_pictures_of_the_same_seed_are_alike():
    noise = "<noise><type>gaussian</type><mean>0</mean><stddev>0.02</stddev></noise>"
    first, second, other = (image(samples(camera(extra=noise, size=(32, 24)), seed=s)).pixels for s in (1, 1, 2))
    assert np.array_equal(first, second)
    assert not np.array_equal(first, other)


def test_a_field_of_view_of_a_whole_turn_is_drawn_as_far_as_a_pinhole_sees():
    eye = camera().replace("1.047", "6.283")
    simulation = Simulation(world(eye), warn=lambda line: None)
    assert "<horizontal_fov> is 6.283, a pinhole shows 2.79 rad of it" in simulation.warnings[0]
    assert image(simulation.advance(FRAME)).pixels.shape[:2] == (480, 640)
    with pytest.raises(DescriptionError, match=r"above 0 and at most 2 pi, got 6\.3"):
        Simulation(world(camera().replace("1.047", "6.3")))
