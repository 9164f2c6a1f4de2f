"""Parameters of SLAM, under the names that slam_toolbox gives them."""

from dataclasses import dataclass


@dataclass(frozen=True)
class SlamConfig:
    """Parameters of online SLAM; names and units are slam_toolbox's where it has them.

    Attributes
    ----------
    resolution : float
        Side of a cell of the map [m].
    max_laser_range : float
        Longest range [m] whose end point is used; longer beams only show free space.
    minimum_time_interval : float
        Scans that follow the last matched one sooner than this [s] are not looked at.
    minimum_travel_distance, minimum_travel_heading : float
        Motion by odometry [m], [rad] after which a scan is added to the map.
    match_every_scan : bool
        Match the scans in between as well: they correct the pose, but are not added to the map.
    scan_buffer_size : int
        Number of latest key scans that a new scan is matched against.
    scan_buffer_maximum_scan_distance : float
        Key scans farther away than this [m] leave that buffer.
    link_match_minimum_response_fine : float
        Least part of the points that must lie on lines of the buffer; below it odometry is believed.
    correlation_search_space_dimension : float
        Side [m] of the window around the odometry's prediction that is searched.
    coarse_search_angle_offset : float
        Half width [rad] of that window.
    distance_variance_penalty, angle_variance_penalty : float
        Distance [m] and angle [rad] from the prediction at which a pose scores 0.2 less.
    do_loop_closing : bool
        Look for places that were seen before.
    loop_search_maximum_distance : float
        Largest distance [m] to an earlier key scan for its place to be tried.
    loop_match_minimum_chain_size : int
        Least number of earlier key scans in a row near the robot.
    loop_search_space_dimension : float
        Largest side [m] of the window of a loop closure; it is smaller where little drift is possible.
    min_pass_through : int
        Beams that must have reached a cell for it to be known.
    occupancy_threshold : float
        Share of ending beams above which a cell is occupied.
    """

    resolution: float = 0.05
    max_laser_range: float = 20.0
    minimum_time_interval: float = 0.0
    minimum_travel_distance: float = 0.2
    minimum_travel_heading: float = 0.2
    match_every_scan: bool = False
    scan_buffer_size: int = 10
    scan_buffer_maximum_scan_distance: float = 10.0
    link_match_minimum_response_fine: float = 0.3
    correlation_search_space_dimension: float = 1.0
    coarse_search_angle_offset: float = 0.5
    distance_variance_penalty: float = 1.0
    angle_variance_penalty: float = 1.0
    do_loop_closing: bool = True
    loop_search_maximum_distance: float = 4.0
    loop_match_minimum_chain_size: int = 5
    loop_search_space_dimension: float = 8.0
    min_pass_through: int = 2
    occupancy_threshold: float = 0.1
