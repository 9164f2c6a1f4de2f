"""What the figures should reach, and what the programs that people know reach."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Goal:
    """A limit: at most, or at least, so much.

    `theirs` is the figure of the software that people know, and `floor` the name of the figure that tells what this
    one is made of takes bare: on another machine, or a busy one, how far they lie apart says more than the limit.
    """

    limit: float
    at_least: bool = False
    theirs: str = ""
    floor: str = ""

    def is_met(self, value: float) -> bool:
        return value >= self.limit if self.at_least else value <= self.limit

    def __str__(self) -> str:
        return f"{'>=' if self.at_least else '<='} {self.limit:g}"


def goal_of(figure: str) -> Goal | None:
    """Return the goal of a figure, None where there is none."""
    return GOALS.get(figure)


GOALS = {
    "bags.record_1_khz_lost": Goal(0),
    "bags.record_10_khz_lost": Goal(0),
    "bags.record_100_mb_per_s_lost": Goal(0),
    "bags.kill_9_lost_s": Goal(0.1),
    "bags.play_lost": Goal(0),
    "bags.play_late_99_percent_ms": Goal(5.0),
    "bags.info_s": Goal(0.5),
    "cpp.first_build_of_a_talker_s": Goal(60.0),
    "cpp.next_build_of_a_talker_s": Goal(10.0),
    "cpp.talker_mb": Goal(40.0),
    "cpp.string_64_b_received_per_s": Goal(300_000, at_least=True),
    "demo.real_time_factor": Goal(0.995, at_least=True),
    "demo.moving_robot_s": Goal(10.0),
    "demo.end_s": Goal(5.0),
    "demo.goals_reached": Goal(3, at_least=True),
    "demo.contacts": Goal(0),
    "command.import_and_node_s": Goal(0.3),
    "command.ros2_help_s": Goal(0.15),
    "command.ros2_topic_list_s": Goal(0.5),
    "command.ros2_topic_list_with_daemon_s": Goal(0.25),
    "control.manager_cycle_7_joints_us": Goal(200.0),
    "control.real_time_factor_arm_1_kHz": Goal(1.0, at_least=True),
    "control.cycles_missed_in_10_s_at_1_kHz": Goal(0),
    "control.latest_cycle_at_1_kHz_ns": Goal(0),
    "control.trajectory_error_beside_one_cycle_mrad": Goal(5.0),
    "control.rover_10_m_straight_error_mm": Goal(5.0),
    "control.rover_ten_turns_error_percent": Goal(0.1),
    "arms.irb120_inverse_poses_per_s": Goal(1e6, at_least=True),
    "arms.irb1600_inverse_poses_per_s": Goal(1e6, at_least=True),
    "arms.irb6700_inverse_poses_per_s": Goal(1e6, at_least=True),
    "arms.irb8700_inverse_poses_per_s": Goal(1e6, at_least=True),
    "arms.kr500_2mt_inverse_poses_per_s": Goal(1e6, at_least=True),
    "arms.round_trip_worst_error_m": Goal(1e-9),
    "motion.time_worst_error_percent": Goal(3.0),
    "motion.path_worst_error_mm": Goal(0.1),
    "motion.times_real_time": Goal(1000.0, at_least=True),
    "rapid.public_files_parsed_percent": Goal(97.0, at_least=True, theirs="56 (rapidchecker)"),
    "rapid.public_files_parse_ms_mean": Goal(50.0),
    "rapid.public_files_parse_ms_worst": Goal(50.0),
    "rapid.statements_per_s": Goal(200_000.0, at_least=True),
    "rapid.check_command_s": Goal(0.5),
    "welding.correct_1000_points_s": Goal(1.0),
    "welding.convergence_m": Goal(1e-6),
    "welding.line_corrected_across_rms_mm": Goal(0.27, theirs="0.27 (measured)"),
    "welding.curve_within_half_a_millimetre_percent": Goal(100.0, at_least=True),
    "description.state_publisher_1000_joints_cpu_percent": Goal(10.0),
    "description.public_urdf_load_percent": Goal(98.0, at_least=True),
    "description.public_sdf_load_percent": Goal(98.0, at_least=True),
    "determinism.bags_alike": Goal(1, at_least=True),
    "determinism.goals_reached": Goal(22, at_least=True),
    "determinism.contacts": Goal(0),
    "determinism.simulated_s": Goal(300.0, at_least=True),
    "learning.lidar_steps_per_s": Goal(5000.0, at_least=True),
    "lighting.calibrated_4_points_both_flips_worst_median_mm": Goal(1.2),
    "lighting.mqtt_to_dmx_median_ms": Goal(2.0),
    "lighting.mqtt_to_dmx_99_percent_ms": Goal(10.0),
    "lighting.40_heads_at_44_hz_cpu_percent": Goal(10.0),
    "lockstep.arena_times_real_time": Goal(10.0, at_least=True),
    "lockstep.waffle_lidar_times_real_time": Goal(30.0, at_least=True),
    "lockstep.turtlesim_times_real_time": Goal(1000.0, at_least=True),
    "lockstep.message_us": Goal(60.0, floor="lockstep.message_in_real_time_us"),
    "lockstep.timer_us": Goal(100.0, floor="lockstep.timer_in_real_time_us"),
    "lockstep.switch_us": Goal(15.0, floor="lockstep.switch_in_real_time_us"),
    "localization.likelihood_field_update_ms": Goal(1.5),
    "localization.likelihood_field_error_m": Goal(0.03),
    "localization.likelihood_field_error_deg": Goal(1.5),
    "localization.global_found": Goal(0.99, at_least=True),
    "localization.kidnapped_found": Goal(0.99, at_least=True),
    "loading.first_slowest_s": Goal(10.0),
    "loading.second_slowest_s": Goal(5.0),
    "mapping.intel_5hz_translation_m": Goal(0.040, theirs="0.031 graph mapping"),
    "mapping.intel_5hz_translation_median_m": Goal(0.022),
    "mapping.intel_5hz_rotation_deg": Goal(1.3),
    "mapping.fr079_with_offset_translation_m": Goal(0.036, theirs="0.056 graph mapping"),
    "mapping.fr079_with_offset_rotation_deg": Goal(0.8),
    "navigation.mppi_cycle_2000x56_ms": Goal(2.5),
    "navigation.dwb_cycle_ms": Goal(5.0),
    "navigation.teb_cycle_ms": Goal(5.0),
    "rclpy.serialize_String_us": Goal(1.1, theirs="2.2"),
    "rclpy.deserialize_String_us": Goal(1.35, theirs="2.7"),
    "rclpy.serialize_JointState_us": Goal(6.45, theirs="12.9"),
    "rclpy.deserialize_JointState_us": Goal(4.85, theirs="9.7"),
    "rclpy.serialize_LaserScan_us": Goal(8.0, theirs="16"),
    "rclpy.deserialize_LaserScan_us": Goal(4.5, theirs="9"),
    "rclpy.serialize_Image_us": Goal(28.5, theirs="57", floor="rclpy.floor_copy_Image_us"),
    "rclpy.deserialize_Image_us": Goal(27.0, theirs="54", floor="rclpy.floor_copy_Image_us"),
    "rclpy.serialize_Odometry_us": Goal(14.5, theirs="29"),
    "rclpy.deserialize_Odometry_us": Goal(15.0, theirs="30"),
    "rclpy.serialize_TFMessage_us": Goal(43.0, theirs="86"),
    "rclpy.deserialize_TFMessage_us": Goal(120.5, theirs="241"),
    "rclpy.serialize_PointCloud2_us": Goal(39.0, theirs="78", floor="rclpy.floor_copy_PointCloud2_us"),
    "rclpy.deserialize_PointCloud2_us": Goal(36.0, theirs="72", floor="rclpy.floor_copy_PointCloud2_us"),
    "rclpy.String_received_per_s": Goal(
        70_000, at_least=True, theirs="14,000", floor="rclpy.floor_String_received_per_s"
    ),
    "rclpy.String_lost": Goal(0, theirs="159,000 a second"),
    "rclpy.Image_received_per_s": Goal(4680, at_least=True, theirs="1170", floor="rclpy.floor_Image_received_per_s"),
    "rclpy.PointCloud2_received_per_s": Goal(
        3520, at_least=True, theirs="880", floor="rclpy.floor_PointCloud2_received_per_s"
    ),
    "rclpy.round_trip_p50_us": Goal(175, theirs="125 over DDS", floor="rclpy.floor_round_trip_attached_p50_us"),
    "rclpy.round_trip_p99_us": Goal(329, theirs="235 over DDS", floor="rclpy.floor_round_trip_attached_p99_us"),
    "rclpy.service_call_p50_us": Goal(160, theirs="114 over DDS", floor="rclpy.floor_service_call_attached_p50_us"),
    "rclpy.service_call_p99_us": Goal(314, theirs="224 over DDS", floor="rclpy.floor_service_call_attached_p99_us"),
    "rclpy.dds_round_trip_p50_us": Goal(125, theirs="125", floor="rclpy.floor_dds_p50_us"),
    "rclpy.dds_round_trip_p99_us": Goal(235, theirs="235", floor="rclpy.floor_dds_p99_us"),
    "rclpy.dds_service_call_p50_us": Goal(114, theirs="114", floor="rclpy.floor_dds_p50_us"),
    "rclpy.dds_service_call_p99_us": Goal(224, theirs="224", floor="rclpy.floor_dds_p99_us"),
    "rclpy.round_trip_times_floor": Goal(1.15),
    "rclpy.service_call_times_floor": Goal(1.15),
    "rclpy.dds_round_trip_times_floor": Goal(1.15),
    "rclpy.dds_service_call_times_floor": Goal(1.15),
    "rclpy.timer_1khz_cpu_percent": Goal(4.0, theirs="10.7", floor="rclpy.floor_timer_1khz_cpu_percent"),
    "rclpy.timer_1khz_jitter_p99_us": Goal(87, theirs="87", floor="rclpy.floor_timer_1khz_jitter_p99_us"),
    "rclpy.start_ms": Goal(127, theirs="127"),
    "rclpy.one_publisher_mb": Goal(54, theirs="54"),
    "transport.zenoh_small_lost": Goal(0),
    "transport.zenoh_graph_of_1000_topics_s": Goal(5.0),
    "transport.zenoh_graph_of_1000_topics_missing": Goal(0),
    "transport.dds_small_lost": Goal(0),
    "transport.dds_graph_of_1000_topics_s": Goal(5.0),
    "transport.dds_graph_of_1000_topics_missing": Goal(0),
    "transport.dds_16_mb_images_lost": Goal(0),
    "transport.dds_16_mb_images_s": Goal(0.3, theirs="0.15"),
    "transport.dds_10_hz_cpu_percent": Goal(2.0, theirs="2.0"),
    "transport.dds_3000_publishers_s": Goal(5.0),
    "studio_hostile.latency_p50_ms": Goal(10.0, floor="studio_hostile.latency_p50_before_ms"),
    "studio_hostile.own_delay_p99_ms": Goal(3.0),
    "studio_hostile.memory_growth_MB": Goal(256.0),
    "fuzz.faults": Goal(0),
    "fuzz.slowest_s": Goal(2.0),
    "fuzz.memory_growth_mb": Goal(50.0),
    "soak.memory_growth_mb": Goal(1.0),
    "soak.threads_left": Goal(0),
    "soak.endpoints_left": Goal(0),
    "soak.errors": Goal(0),
    "fleet.one_share_of_bare": Goal(0.5, at_least=True),
    "fleet.one_speed": Goal(10.0, at_least=True, floor="fleet.one_bare_speed"),
    "fleet.one_lidar_speed": Goal(10.0, at_least=True, floor="fleet.one_lidar_bare_speed"),
    "fleet.one_camera_speed": Goal(2.0, at_least=True, floor="fleet.one_camera_bare_speed"),
    "fleet.twenty_share_of_bare": Goal(0.5, at_least=True),
    "fleet.twenty_speed": Goal(1.0, at_least=True, floor="fleet.twenty_bare_speed"),
    "fleet.twenty_lidars_speed": Goal(1.0, at_least=True, floor="fleet.twenty_lidars_bare_speed"),
    "fleet.twenty_memory_mb": Goal(500.0),
    "fleet.twenty_lidars_memory_mb": Goal(500.0),
    "fleet.twenty_cameras_memory_mb": Goal(500.0),
    "fleet.spawn_200_boxes_s": Goal(0.3),
    "simulation.real_time_factor_with_50_boxes": Goal(5.0, at_least=True),
    "simulation.scan_820_rays_ms": Goal(0.5),
    "simulation.scan_720_rays_ms": Goal(0.5),
    "simulation.rgbd_frame_ms": Goal(5.0),
    "simulation.real_time_factor_workshop": Goal(5.0, at_least=True),
    "simulation.first_scan_s": Goal(3.0),
    "simulation.straight_10_m_error_mm": Goal(5.0),
    "simulation.ten_turns_error_percent": Goal(0.1),
}
