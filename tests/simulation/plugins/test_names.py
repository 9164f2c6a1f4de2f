"""Every plugin under each of the names that Gazebo classic, ROS 1 and gz have for it, with their parameters."""

import pytest

from daidalos.description import urdf
from daidalos.description.errors import DescriptionError
from daidalos.samples.commands import FlagCommand, SignalCommand
from daidalos.samples.sensors import ImageSample
from daidalos.simulation import Simulation
from daidalos.simulation.plugins.ros2_control import Ros2Control
from simulation.models import box, world
from simulation.plugins.vehicles import four_wheels

LEFT = "<left_joint>fl_j</left_joint><left_joint>rl_j</left_joint>"
RIGHT = "<right_joint>fr_j</right_joint><right_joint>rr_j</right_joint>"
STEER = "<left_steering_joint>fl_steer</left_steering_joint><right_steering_joint>fr_steer</right_steering_joint>"
DRIVEN = "".join(
    f"<{place}_{side}_joint>{joint}</{place}_{side}_joint>"
    for place, side, joint in (
        *(("front", "left", "fl_j"), ("front", "right", "fr_j")),
        *(("rear", "left", "rl_j"), ("rear", "right", "rr_j")),
    )
)
BASES = (
    "<publish_odom>true</publish_odom><publish_odom_tf>true</publish_odom_tf>"
    "<robot_base_frame>chassis</robot_base_frame>"
)
CAMERA = "<camera><image><width>8</width><height>8</height></image></camera>"

# File name, parameters, and topics that it takes or tells.
IN_MODELS = [
    (
        "libgazebo_ros_diff_drive.so",
        f"<ros><namespace>/robot</namespace><remapping>cmd_vel:=go</remapping></ros><update_rate>50</update_rate>"
        f"<num_wheel_pairs>2</num_wheel_pairs>{LEFT}{RIGHT}{BASES}<wheel_separation>0.5</wheel_separation>"
        "<wheel_diameter>0.2</wheel_diameter><max_wheel_torque>20</max_wheel_torque>"
        "<max_wheel_acceleration>1.0</max_wheel_acceleration><publish_wheel_tf>false</publish_wheel_tf>"
        "<odometry_frame>odom</odometry_frame><odometry_topic>odom</odometry_topic>"
        "<odometry_source>0</odometry_source>",
        {"/robot/go", "/robot/odom", "/tf"},
    ),
    (
        "libgazebo_ros_diff_drive.so",
        "<legacyMode>false</legacyMode><rosDebugLevel>na</rosDebugLevel><robotNamespace>robot</robotNamespace>"
        "<commandTopic>go</commandTopic><odometryTopic>odom</odometryTopic><odometryFrame>odom</odometryFrame>"
        "<publishWheelTF>true</publishWheelTF><publishWheelJointState>true</publishWheelJointState>"
        "<publishTf>1</publishTf><publishOdomTF>true</publishOdomTF><odometrySource>encoder</odometrySource>"
        "<updateRate>100</updateRate><leftJoint>rl_j</leftJoint><rightJoint>rr_j</rightJoint>"
        "<wheelSeparation>0.5</wheelSeparation><wheelDiameter>0.2</wheelDiameter><wheelTorque>20</wheelTorque>"
        "<wheelAcceleration>1</wheelAcceleration><robotBaseFrame>chassis</robotBaseFrame><alwaysOn>true</alwaysOn>",
        {"/robot/go", "/robot/odom", "/robot/joint_states", "/tf"},
    ),
    (
        "gz-sim-diff-drive-system",
        f"{LEFT}{RIGHT}<wheel_separation>0.5</wheel_separation><wheel_radius>0.1</wheel_radius>"
        "<odom_publish_frequency>20</odom_publish_frequency><topic>cmd_vel</topic><odom_topic>odom</odom_topic>"
        "<tf_topic>tf</tf_topic><frame_id>odom</frame_id><child_frame_id>base</child_frame_id>"
        "<max_linear_acceleration>1</max_linear_acceleration><min_linear_acceleration>-1</min_linear_acceleration>"
        "<max_angular_acceleration>2</max_angular_acceleration><min_angular_acceleration>-2</min_angular_acceleration>"
        "<max_linear_velocity>0.5</max_linear_velocity><min_linear_velocity>-0.5</min_linear_velocity>",
        {"/cmd_vel", "/odom", "/tf"},
    ),
    (
        "libignition-gazebo6-diff-drive-system.so",
        f"{LEFT}{RIGHT}<wheel_separation>0.5</wheel_separation><wheel_radius>0.1</wheel_radius>",
        {"/model/cart/cmd_vel", "/model/cart/odometry", "/model/cart/tf"},
    ),
    (
        "libgazebo_ros_skid_steer_drive.so",
        "<updateRate>100</updateRate><robotNamespace>/</robotNamespace><leftFrontJoint>fl_j</leftFrontJoint>"
        "<rightFrontJoint>fr_j</rightFrontJoint><leftRearJoint>rl_j</leftRearJoint>"
        "<rightRearJoint>rr_j</rightRearJoint>"
        "<wheelSeparation>0.5</wheelSeparation><wheelDiameter>0.2</wheelDiameter><torque>20</torque>"
        "<robotBaseFrame>chassis</robotBaseFrame><commandTopic>cmd_vel</commandTopic><broadcastTF>true</broadcastTF>"
        "<odometryTopic>odom</odometryTopic><odometryFrame>odom</odometryFrame><covariance_x>0.01</covariance_x>",
        {"/cmd_vel", "/odom", "/tf"},
    ),
    (
        "libgazebo_ros_ackermann_drive.so",
        f"<update_rate>100</update_rate>{DRIVEN}{STEER}<max_steer>0.6</max_steer><max_speed>20</max_speed>"
        "<max_steering_angle>7.85</max_steering_angle><left_steering_pid_gain>1500 0 1</left_steering_pid_gain>"
        "<left_steering_i_range>0 0</left_steering_i_range><right_steering_pid_gain>1500 0 1</right_steering_pid_gain>"
        "<right_steering_i_range>0 0</right_steering_i_range>"
        "<linear_velocity_pid_gain>1000 0 1</linear_velocity_pid_gain>"
        f"<linear_velocity_i_range>0 0</linear_velocity_i_range>{BASES}<publish_wheel_tf>true</publish_wheel_tf>"
        "<publish_distance>true</publish_distance><odometry_frame>odom_demo</odometry_frame>",
        {"/cmd_vel", "/odom", "/tf", "/distance"},
    ),
    (
        "gz::sim::systems::AckermannSteering",
        f"{LEFT}{RIGHT}{STEER}<kingpin_width>0.5</kingpin_width><steering_limit>0.5</steering_limit>"
        "<wheel_base>0.6</wheel_base><wheel_separation>0.5</wheel_separation><wheel_radius>0.1</wheel_radius>"
        "<min_velocity>-1</min_velocity><max_velocity>1</max_velocity><min_acceleration>-3</min_acceleration>"
        "<max_acceleration>3</max_acceleration>",
        {"/model/cart/cmd_vel", "/model/cart/odometry", "/model/cart/tf"},
    ),
    (
        "libgazebo_ros_planar_move.so",
        f"<update_rate>100</update_rate><publish_rate>10</publish_rate>{BASES}<odometry_frame>odom</odometry_frame>"
        "<covariance_x>0.0001</covariance_x><covariance_y>0.0001</covariance_y><covariance_yaw>0.01</covariance_yaw>",
        {"/cmd_vel", "/odom", "/tf"},
    ),
    (
        "libgazebo_ros_planar_move.so",
        "<commandTopic>go</commandTopic><odometryTopic>odom</odometryTopic><odometryFrame>odom</odometryFrame>"
        "<odometryRate>20</odometryRate><robotBaseFrame>chassis</robotBaseFrame>",
        {"/go", "/odom", "/tf"},
    ),
    (
        "libgazebo_ros_joint_state_publisher.so",
        "<ros><remapping>~/out:=joint_states</remapping></ros><update_rate>30</update_rate>"
        "<joint_name>fl_j</joint_name>",
        {"/joint_states"},
    ),
    (
        "libgazebo_ros_joint_state_publisher.so",
        "<jointName>fl_j, fr_j</jointName><updateRate>30</updateRate><robotNamespace>r</robotNamespace>",
        {"/r/joint_states"},
    ),
    (
        "gz-sim-joint-state-publisher-system",
        "<topic>joint_states</topic><joint_name>fl_j</joint_name>",
        {"/joint_states"},
    ),
    (
        "libgazebo_ros_joint_pose_trajectory.so",
        "<ros><remapping>set_joint_trajectory:=poses</remapping></ros><update_rate>2</update_rate>",
        {"/poses"},
    ),
    (
        "libgazebo_ros_joint_pose_trajectory.so",
        "<robotNamespace>/</robotNamespace><serviceName>set_it</serviceName><topicName>poses</topicName>"
        "<updateRate>5</updateRate>",
        {"/poses"},
    ),
    ("gz-sim-joint-controller-system", "<joint_name>fl_j</joint_name>", {"/model/cart/joint/fl_j/cmd_vel"}),
    (
        "ignition::gazebo::systems::JointPositionController",
        "<joint_name>fl_steer</joint_name><p_gain>10</p_gain><d_gain>1</d_gain><i_gain>1</i_gain><i_max>1</i_max>"
        "<i_min>-1</i_min><cmd_max>100</cmd_max><cmd_min>-100</cmd_min>",
        {"/model/cart/joint/fl_steer/0/cmd_pos"},
    ),
    (
        "gz-sim-joint-position-controller-system",
        "<joint_name>fl_steer</joint_name><sub_topic>steer</sub_topic>",
        {"/model/cart/steer"},
    ),
    (
        "libgazebo_ros_imu.so",
        "<alwaysOn>true</alwaysOn><bodyName>chassis</bodyName><topicName>imu</topicName>"
        "<serviceName>imu_service</serviceName>"
        "<gaussianNoise>0.001</gaussianNoise><updateRate>20</updateRate><frameName>imu</frameName>"
        "<xyzOffset>0 0 0</xyzOffset>",
        {"/imu"},
    ),
    (
        "libhector_gazebo_ros_imu.so",
        "<updateRate>50</updateRate><bodyName>chassis</bodyName><frameId>imu</frameId><topicName>imu/data</topicName>"
        "<accelOffset>0 0 0</accelOffset><accelDrift>0.01</accelDrift><accelDriftFrequency>0.1</accelDriftFrequency>"
        "<accelGaussianNoise>0.01</accelGaussianNoise><rateOffset>0</rateOffset><rateDrift>0</rateDrift>"
        "<rateDriftFrequency>0</rateDriftFrequency><rateGaussianNoise>0.1 0.1 0.2</rateGaussianNoise>"
        "<headingDrift>0</headingDrift><headingGaussianNoise>0</headingGaussianNoise>",
        {"/imu/data"},
    ),
    (
        "libhector_gazebo_ros_magnetic.so",
        "<bodyName>chassis</bodyName><frameId>m</frameId><offset>0 0 0</offset><gaussianNoise>1e-8</gaussianNoise>",
        {"/magnetic"},
    ),
    (
        "libhector_gazebo_ros_gps.so",
        "<updateRate>4</updateRate><bodyName>chassis</bodyName><frameId>gps</frameId><topicName>fix</topicName>"
        "<referenceLatitude>50</referenceLatitude><referenceLongitude>8</referenceLongitude><offset>0 0 0</offset>"
        "<referenceHeading>0</referenceHeading><referenceAltitude>0</referenceAltitude><drift>0.1 0.1 0.1</drift>"
        "<driftFrequency>0.01 0.01 0.01</driftFrequency><gaussianNoise>0.1 0.1 0.1</gaussianNoise>",
        {"/fix"},
    ),
    (
        "libgazebo_ros_p3d.so",
        "<ros><remapping>odom:=truth</remapping></ros><body_name>chassis</body_name><frame_name>world</frame_name>"
        "<update_rate>5</update_rate><xyz_offset>0 0 0</xyz_offset><rpy_offset>0 0 0</rpy_offset>"
        "<gaussian_noise>0.01</gaussian_noise>",
        {"/truth"},
    ),
    (
        "libgazebo_ros_p3d.so",
        "<bodyName>chassis</bodyName><topicName>truth</topicName><frameName>world</frameName><updateRate>5</updateRate>"
        "<xyzOffsets>0 0 0</xyzOffsets><rpyOffsets>0 0 0</rpyOffsets><gaussianNoise>0</gaussianNoise>"
        "<alwaysOn>1</alwaysOn>",
        {"/truth"},
    ),
    (
        "gz-sim-odometry-publisher-system",
        "<odom_frame>o</odom_frame><robot_base_frame>b</robot_base_frame><dimensions>3</dimensions>",
        {"/model/cart/odometry"},
    ),
    (
        "libgazebo_ros_ft_sensor.so",
        "<update_rate>10</update_rate><frame_name>fl</frame_name><joint_name>fl_j</joint_name>"
        "<gaussian_noise>0.1</gaussian_noise>",
        {"/wrench"},
    ),
    (
        "libgazebo_ros_ft_sensor.so",
        "<updateRate>9</updateRate><topicName>ft</topicName><jointName>fl_j</jointName>",
        {"/ft"},
    ),
    ("libgazebo_ros_force.so", "<link_name>chassis</link_name><force_frame>link</force_frame>", {"/gazebo_ros_force"}),
    ("libgazebo_ros_force.so", "<bodyName>chassis</bodyName><topicName>push</topicName>", {"/push"}),
    (
        "libgazebo_ros_wheel_slip.so",
        '<wheel link_name="fl"><slip_compliance_lateral>0</slip_compliance_lateral>'
        "<slip_compliance_longitudinal>0.1</slip_compliance_longitudinal><wheel_normal_force>30</wheel_normal_force>"
        "<wheel_radius>0.1</wheel_radius></wheel>",
        {"/wheel_slip"},
    ),
    ("libWheelSlipPlugin.so", '<wheel link_name="fl"><wheel_normal_force>30</wheel_normal_force></wheel>', set()),
    (
        "gz::sim::systems::WheelSlip",
        '<wheel link_name="fl"><slip_compliance_lateral>0.1</slip_compliance_lateral>'
        "<wheel_normal_force>30</wheel_normal_force>"
        "<wheel_radius>0.1</wheel_radius></wheel>",
        set(),
    ),
    (
        "libgazebo_ros_vacuum_gripper.so",
        "<ros><remapping>switch:=pump</remapping></ros><link_name>chassis</link_name><max_distance>0.1</max_distance>"
        "<fixed>fl</fixed>",
        {"/pump", "/grasping"},
    ),
    (
        "libgazebo_ros_vacuum_gripper.so",
        "<robotNamespace>/robot</robotNamespace><bodyName>chassis</bodyName><topicName>grasping</topicName>",
        {"/robot/grasping/on", "/robot/grasping/off", "/robot/grasping/grasping"},
    ),
    ("gz-sim-velocity-control-system", "<topic>go</topic><initial_linear>0 0 0</initial_linear>", {"/go"}),
    (
        "gz-sim-pose-publisher-system",
        "<publish_link_pose>true</publish_link_pose><use_pose_vector_msg>true</use_pose_vector_msg>",
        {"/model/cart/pose"},
    ),
]

# Type of the sensor, what is in it, file name, parameters, topics.
IN_SENSORS = [
    (
        *("ray", "", "libgazebo_ros_ray_sensor.so"),
        "<ros><remapping>~/out:=scan</remapping></ros><output_type>sensor_msgs/LaserScan</output_type>"
        "<frame_name>laser</frame_name><min_intensity>0</min_intensity>",
        {"/scan"},
    ),
    (
        *("ray", "", "libgazebo_ros_ray_sensor.so"),
        "<ros><remapping>~/out:=range</remapping></ros><output_type>sensor_msgs/Range</output_type>"
        "<radiation_type>ultrasound</radiation_type>",
        {"/range"},
    ),
    *(
        (
            "ray",
            "",
            file,
            "<topicName>scan</topicName><frameName>laser</frameName><robotNamespace>r</robotNamespace>",
            {"/r/scan"},
        )
        for file in ("libgazebo_ros_laser.so", "libgazebo_ros_gpu_laser.so")
    ),
    *(
        (
            "ray",
            "",
            file,
            "<topicName>p</topicName><min_range>0.9</min_range><max_range>130</max_range>"
            "<gaussianNoise>0.01</gaussianNoise>",
            {"/p"},
        )
        for file in ("libgazebo_ros_velodyne_laser.so", "libgazebo_ros_velodyne_gpu_laser.so")
    ),
    (
        "ray",
        "",
        "libgazebo_ros_block_laser.so",
        "<topicName>p</topicName><updateRate>5</updateRate><hokuyoMinIntensity>1</hokuyoMinIntensity>",
        {"/p"},
    ),
    (
        *("ray", "", "libgazebo_ros_range.so"),
        "<gaussianNoise>0.01</gaussianNoise><alwaysOn>true</alwaysOn><updateRate>5</updateRate>"
        "<topicName>sonar</topicName>"
        "<frameName>s</frameName><fov>0.5</fov><radiation>ultrasound</radiation>",
        {"/sonar"},
    ),
    (
        *("camera", CAMERA, "libgazebo_ros_camera.so"),
        "<ros><namespace>n</namespace><remapping>image_raw:=picture</remapping></ros><camera_name>eye</camera_name>"
        "<frame_name>eye</frame_name><hack_baseline>0.07</hack_baseline><triggered>false</triggered>",
        {"/n/picture", "/n/eye/camera_info"},
    ),
    (
        *("camera", CAMERA, "libgazebo_ros_camera.so"),
        "<alwaysOn>true</alwaysOn><updateRate>0.0</updateRate><cameraName>eye</cameraName>"
        "<imageTopicName>image_raw</imageTopicName>"
        "<cameraInfoTopicName>camera_info</cameraInfoTopicName><frameName>eye</frameName>"
        "<hackBaseline>0.07</hackBaseline>"
        "<distortionK1>0</distortionK1><distortionK2>0</distortionK2><distortionK3>0</distortionK3>"
        "<distortionT1>0</distortionT1><distortionT2>0</distortionT2><CxPrime>0</CxPrime><Cx>0</Cx><Cy>0</Cy>"
        "<focalLength>0</focalLength>",
        {"/eye/image_raw", "/eye/camera_info"},
    ),
    (
        *("depth", CAMERA, "libgazebo_ros_camera.so"),
        "<camera_name>eye</camera_name><min_depth>0.1</min_depth><max_depth>8</max_depth>",
        {"/eye/image_raw", "/eye/depth/image_raw", "/eye/points"},
    ),
    *(
        (
            *("depth", CAMERA, file),
            "<cameraName>k</cameraName><imageTopicName>rgb</imageTopicName>"
            "<depthImageTopicName>depth</depthImageTopicName>"
            "<pointCloudTopicName>cloud</pointCloudTopicName><cameraInfoTopicName>info</cameraInfoTopicName>"
            "<depthImageCameraInfoTopicName>depth_info</depthImageCameraInfoTopicName>"
            "<pointCloudCutoff>0.4</pointCloudCutoff>"
            "<pointCloudCutoffMax>5</pointCloudCutoffMax>",
            {"/k/rgb", "/k/depth", "/k/cloud", "/k/info", "/k/depth_info"},
        )
        for file in ("libgazebo_ros_openni_kinect.so", "libgazebo_ros_depth_camera.so")
    ),
    (
        *("imu", "", "libgazebo_ros_imu_sensor.so"),
        "<ros><remapping>~/out:=imu</remapping></ros>"
        "<initial_orientation_as_reference>false</initial_orientation_as_reference>"
        "<frame_name>imu</frame_name>",
        {"/imu"},
    ),
    (
        *("imu", "", "libgazebo_ros_imu_sensor.so"),
        "<topicName>imu</topicName><bodyName>link</bodyName><updateRateHZ>10</updateRateHZ>"
        "<gaussianNoise>0</gaussianNoise>"
        "<xyzOffset>0 0 0</xyzOffset><rpyOffset>0 0 0</rpyOffset><frameName>imu</frameName>"
        "<initialOrientationAsReference>false</initialOrientationAsReference>",
        {"/imu"},
    ),
    (
        "gps",
        "",
        "libgazebo_ros_gps_sensor.so",
        "<ros><remapping>~/out:=fix</remapping></ros><frame_name>gps</frame_name>",
        {"/fix"},
    ),
    (
        *("contact", "", "libgazebo_ros_bumper.so"),
        "<ros><remapping>bumper_states:=bump</remapping></ros><frame_name>world</frame_name>",
        {"/bump"},
    ),
    (
        "contact",
        "",
        "libgazebo_ros_bumper.so",
        "<bumperTopicName>bump</bumperTopicName><frameName>world</frameName>",
        {"/bump"},
    ),
]

BUILT_IN = (
    *(
        "Physics",
        "UserCommands",
        "SceneBroadcaster",
        "Sensors",
        "Imu",
        "Contact",
        "NavSat",
        "Altimeter",
        "Magnetometer",
    ),
    *("ForceTorque", "AirPressure", "LogicalCamera"),
)


def plugin(file, parameters):
    words = f"name='{file}' filename='gz-sim-systems'" if "::" in file else f"name='p' filename='{file}'"
    return f"<plugin {words}>{parameters}</plugin>"


def topics_of(simulation):
    return {*simulation.publications, *simulation.subscriptions, *simulation.switches}


@pytest.mark.parametrize(
    ("file", "parameters", "topics"), IN_MODELS, ids=lambda value: value if "<" not in value else ""
)
def test_plugins_of_models(file, parameters, topics):
    cart = four_wheels(plugin(file, parameters), steered=True)
    simulation = Simulation(world(cart), has_subscribers=lambda topic: True)
    simulation.step(20)
    assert topics <= topics_of(simulation)
    assert not simulation.warnings


@pytest.mark.parametrize(("kind", "inside", "file", "parameters", "topics"), IN_SENSORS, ids=lambda value: "")
def test_plugins_of_sensors(kind, inside, file, parameters, topics):
    sensor = f"<sensor name='s' type='{kind}'>{inside}{plugin(file, parameters)}</sensor>"
    simulation = Simulation(world(box("b", extra=sensor)), has_subscribers=lambda topic: True)
    simulation.step(2)
    assert topics <= topics_of(simulation)
    assert not simulation.warnings


@pytest.mark.parametrize("name", BUILT_IN)
def test_what_the_simulator_does_by_itself_needs_no_plugin(name):
    kebab = "".join(f"-{letter.lower()}" if letter.isupper() else letter for letter in name).strip("-")
    names = [f"gz-sim-{kebab}-system", f"ignition::gazebo::systems::{name}"]
    plugins = "".join(plugin(file, "<engine><filename>any</filename></engine>") for file in names)
    simulation = Simulation(world(plugins, box("b", extra="").replace("</model>", f"{plugins}</model>")))
    assert not simulation.warnings


@pytest.mark.parametrize(
    ("camera", "plugin_inside", "topic", "command"),
    [
        ("", "<camera_name>eye</camera_name><triggered>true</triggered>", "/eye/image_trigger", SignalCommand()),
        ("<triggered>true</triggered><trigger_topic>look</trigger_topic>", "", "/look", FlagCommand(True)),
    ],
)
def test_a_triggered_camera_looks_when_it_is_told(camera, plugin_inside, topic, command):
    inside = CAMERA.replace("</camera>", f"{camera}</camera>")
    inside += plugin("libgazebo_ros_camera.so", plugin_inside) if plugin_inside else ""
    sensor = f"<sensor name='s' type='camera'><update_rate>10</update_rate>{inside}</sensor>"
    simulation = Simulation(world(box("b", extra=sensor)))
    assert not simulation.advance(500_000_000)
    assert simulation.command(topic, command) == 1
    samples = simulation.advance(500_000_000)
    assert [sample.stamp_ns for sample in samples if isinstance(sample, ImageSample)] == [600_000_000]
    assert not simulation.warnings


def test_a_parameter_that_nobody_reads_is_named_once():
    parameters = f"{LEFT}{RIGHT}<wheel_seperation>0.5</wheel_seperation><colour>red</colour><colour>blue</colour>"
    simulation = Simulation(world(four_wheels(plugin("libgazebo_ros_diff_drive.so", parameters))))
    (line,) = simulation.warnings
    assert line.startswith("w.sdf:1: plugin 'p' (libgazebo_ros_diff_drive.so) does not use ")
    assert line.endswith("<wheel_seperation> (did you mean <wheel_separation>?), <colour>")


@pytest.mark.parametrize(
    ("file", "parameters", "words"),
    [
        (
            "libgazebo_ros_diff_drive.so",
            f"{LEFT}{RIGHT}<wheel_separation>wide</wheel_separation>",
            "<wheel_separation>: .*'wide'",
        ),
        (
            "gz-sim-diff-drive-system",
            f"{LEFT}{RIGHT}<wheel_radius>-1</wheel_radius>",
            "<wheel_radius> should be positive",
        ),
        ("libgazebo_ros_p3d.so", "<xyz_offset>1 2</xyz_offset>", "<xyz_offset>: .* 3 numbers"),
        ("libgazebo_ros_planar_move.so", "<publish_odom>perhaps</publish_odom>", "<publish_odom>: .*'perhaps'"),
        ("libhector_gazebo_ros_imu.so", "<rateOffset>1 2</rateOffset>", "<rateOffset>: .* 3 numbers"),
    ],
)
def test_a_wrong_value_is_an_error_with_its_place(file, parameters, words):
    with pytest.raises(DescriptionError, match=f"^w.sdf:1: .*{words}"):
        Simulation(world(four_wheels(plugin(file, parameters))))


@pytest.mark.parametrize(
    ("file", "parameters", "words"),
    [
        ("libgazebo_ros_p3d.so", "<body_name>nose</body_name>", "there is no link 'nose'"),
        ("libgazebo_ros_ft_sensor.so", "<joint_name>nose</joint_name>", "there is no joint 'nose'"),
        ("libgazebo_ros_ft_sensor.so", "<body_name>chassis</body_name>", "'chassis', expected a link that hangs"),
        ("libgazebo_ros_ackermann_drive.so", STEER, "<front_left_joint> is missing"),
    ],
)
def test_a_plugin_of_an_absent_part_is_left_out(file, parameters, words):
    simulation = Simulation(world(four_wheels(plugin(file, parameters))), warn=lambda line: None)
    assert simulation.warnings[0].startswith("w.sdf:1: ")
    assert words in simulation.warnings[0]


def test_a_plugin_of_a_model_does_nothing_in_a_world():
    simulation = Simulation(world(plugin("libgazebo_ros_p3d.so", ""), plugin("libnothing.so", "")))
    first, second = simulation.warnings
    assert first.endswith("plugin 'p' belongs inside a <model>, left out")
    assert second.endswith("'p': there is no simulator plugin 'nothing' (left out)")


TRANSMISSION = (
    "<transmission name='t_{joint}'><type>transmission_interface/SimpleTransmission</type><joint name='{joint}'>"
    "<hardwareInterface>hardware_interface/{interface}</hardwareInterface></joint><actuator name='m_{joint}'>"
    "<mechanicalReduction>1</mechanicalReduction></actuator></transmission>"
)


def test_ros1s_control_takes_its_joints_from_transmissions():
    joint = (
        "<link name='{0}'><inertial><mass value='1'/><inertia ixx='.1' iyy='.1' izz='.1' ixy='0' ixz='0' iyz='0'/>"
        "</inertial></link><joint name='{0}_j' type='continuous'><parent link='base'/><child link='{0}'/>"
        "<axis xyz='0 0 1'/></joint>"
    )
    parts = [joint.format("a"), joint.format("b"), joint.format("c")]
    parts += [TRANSMISSION.format(joint="a_j", interface="PositionJointInterface")]
    parts += [TRANSMISSION.format(joint="b_j", interface="VelocityJointInterface")]
    parts += ["<gazebo><plugin name='c' filename='libgazebo_ros_control.so'><robotNamespace>/r</robotNamespace>"]
    parts += [
        "<robotSimType>gazebo_ros_control/DefaultRobotHWSim</robotSimType>"
        "<legacyModeNS>true</legacyModeNS></plugin></gazebo>"
    ]
    simulation = Simulation(world())
    robot = urdf.parse(f"<robot name='r'><link name='base'/>{''.join(parts)}</robot>")
    name = simulation.spawn(robot)
    (control,) = (one for one in simulation.instance(name).components if isinstance(one, Ros2Control))
    (info,) = control.hardware
    assert control.parameters.namespace == "/r"
    assert info.command_names == ("a_j/position", "b_j/velocity")
    assert info.state_names == tuple(f"{one}_j/{what}" for one in "ab" for what in ("position", "velocity", "effort"))
    assert not simulation.warnings


@pytest.mark.parametrize(
    ("text", "rate"),
    [
        ("controller_manager: {ros__parameters: {update_rate: 250}}", 250),
        ("/**: {ros__parameters: {update_rate: 250}}", 250),
        ("/**: {controller_manager: {ros__parameters: {update_rate: 250}}}", 250),
        ("/**/controller_manager: {ros__parameters: {update_rate: 250}}", 250),
        ("/*/controller_manager: {ros__parameters: {update_rate: 250}}", 250),
        ("r: {controller_manager: {ros__parameters: {update_rate: 250}}}", 250),
        (
            "/r/controller_manager: {ros__parameters: {update_rate: 250}}\n"
            "/other/controller_manager: {ros__parameters: {update_rate: 50}}\n"
            "controller_manager: {ros__parameters: {update_rate: 20}}",
            250,
        ),
        ("/other/controller_manager: {ros__parameters: {update_rate: 50}}", 100),
    ],
)
def test_a_managers_rate_is_the_one_of_its_namespace(tmp_path, text, rate):
    file = tmp_path / "control.yaml"
    file.write_text(text)
    robot = urdf.parse(
        "<robot name='r'><link name='base'/><link name='a'><inertial><mass value='1'/>"
        "<inertia ixx='.1' iyy='.1' izz='.1' ixy='0' ixz='0' iyz='0'/></inertial></link><joint name='j' "
        "type='continuous'><parent link='base'/><child link='a'/></joint><ros2_control name='c' type='system'>"
        "<hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware><joint name='j'>"
        "<command_interface name='velocity'/></joint></ros2_control><gazebo><plugin name='c' "
        f"filename='gz_ros2_control-system'><parameters>{file}</parameters><ros><namespace>r</namespace></ros>"
        "</plugin></gazebo></robot>"
    )
    simulation = Simulation(world())
    components = simulation.instance(simulation.spawn(robot)).components
    assert [one.rate for one in components if isinstance(one, Ros2Control)] == [rate]
