"""Parameters of SLAM, under the names that slam_toolbox gives them."""

from dataclasses import dataclass

from daidalos.common.parameters import Parameters, parameter


@dataclass(frozen=True)
class SlamConfig(Parameters):
    """Parameters of online SLAM; names are slam_toolbox's where it has them."""

    resolution: float = parameter(0.05, "Side of a cell of the map.", unit="m", above=0.0, read_only=True)
    max_laser_range: float = parameter(
        20.0, "Longest range whose end point is used; longer beams only show free space.", unit="m", above=0.0
    )
    minimum_time_interval: float = parameter(
        0.0, "Time after a scan was added to the map within which no other one is added.", unit="s", minimum=0.0
    )
    minimum_travel_distance: float = parameter(
        0.2, "Motion by odometry after which a scan is added to the map.", unit="m", minimum=0.0
    )
    minimum_travel_heading: float = parameter(
        0.2, "Turn by odometry after which a scan is added to the map.", unit="rad", minimum=0.0
    )
    use_scan_matching: bool = parameter(True, "Whether scans correct the pose; otherwise it is odometry's.")
    use_scan_barycenter: bool = parameter(
        False, "Whether scans are near each other by the middles of their points, not by where they were taken."
    )
    match_every_scan: bool = parameter(
        False, "Whether the scans in between correct the pose as well, without being added to the map."
    )
    scan_buffer_size: int = parameter(10, "Number of latest key scans that a new scan is matched against.", minimum=1)
    scan_buffer_maximum_scan_distance: float = parameter(
        10.0, "Distance from which key scans are not matched against.", unit="m", above=0.0
    )
    link_match_minimum_response_fine: float = parameter(
        0.3, "Least share of the points that must lie on lines of earlier scans; below it odometry is believed.",
        minimum=0.0, maximum=1.0,
    )  # fmt: skip
    correlation_search_space_dimension: float = parameter(
        1.0, "Side of the window around the odometry's prediction that is searched.", unit="m", above=0.0
    )
    coarse_search_angle_offset: float = parameter(
        0.5, "Half width of that window in angle; both grow with what odometry may have erred.", unit="rad", above=0.0
    )
    use_response_expansion: bool = parameter(
        True, "Whether a window three times as large is searched where nothing in the first one fits."
    )
    distance_variance_penalty: float = parameter(
        1.0, "Distance from the prediction at which a pose scores 0.2 less.", unit="m", above=0.0
    )
    angle_variance_penalty: float = parameter(
        1.0, "Angle from the prediction at which a pose scores 0.2 less.", unit="rad", above=0.0
    )
    do_loop_closing: bool = parameter(True, "Whether to look for places that were seen before.")
    loop_search_maximum_distance: float = parameter(
        4.0,
        "Largest distance to an earlier key scan for one match to close a loop; farther ones need three.",
        unit="m",
        minimum=0.0,
    )
    loop_match_minimum_chain_size: int = parameter(
        5, "Least number of earlier key scans in a row near the robot.", minimum=1
    )
    loop_match_minimum_response_coarse: float = parameter(
        0.35, "Mean likelihood of the points that a place must reach to be looked at more closely; 0.6 at least.",
        minimum=0.0, maximum=1.0,
    )  # fmt: skip
    loop_match_minimum_response_fine: float = parameter(
        0.45, "Share of the points that must lie on lines for a closure to be believed; 0.7 at least.",
        minimum=0.0, maximum=1.0,
    )  # fmt: skip
    loop_search_space_dimension: float = parameter(
        8.0, "Largest side of the window of a loop closure; it is smaller where little drift is possible.", unit="m",
        above=0.0,
    )  # fmt: skip
    min_pass_through: int = parameter(2, "Beams that must have reached a cell for it to be known.", minimum=1)
    occupancy_threshold: float = parameter(
        0.1, "Share of ending beams above which a cell is occupied.", minimum=0.0, maximum=1.0
    )
