"""`ros2 bag play`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from typing import TYPE_CHECKING

from ros2bag.api import check_not_negative_int, check_positive_float

from daidalos.bags.errors import BagError
from daidalos.cli.ros2.bag import arguments as common
from daidalos.cli.ros2.bag.qos_overrides import read_overrides
from daidalos.cli.ros2.extension import Status, Verb

if TYPE_CHECKING:
    from rosbag2_py import Player, PlayOptions

_SOURCES = {"service_introspection": "SERVICE_INTROSPECTION", "client_introspection": "CLIENT_INTROSPECTION"}


class PlayVerb(Verb):
    """Play back ROS data from a bag."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the verb's arguments."""
        common.add_bags_arguments(parser)
        common.add_topic_arguments(parser)
        _add_selection(parser)
        _add_timing(parser)
        _add_clock(parser)
        parser.add_argument(
            "--disable-keyboard-controls", action="store_true", help="Disables keyboard controls for playback"
        )
        parser.add_argument(
            "--wait-for-all-acked",
            type=check_not_negative_int,
            default=-1,
            metavar="TIMEOUT",
            help="Wait at the end until all messages are acknowledged, for at most so many milliseconds (0: no limit)",
        )
        parser.add_argument("--disable-loan-message", action="store_true", help="Has no effect: nothing is lent")
        parser.add_argument(
            "--publish-service-requests",
            action="store_true",
            help="Send recorded requests to services again instead of publishing the recorded events",
        )
        parser.add_argument(
            "--service-requests-source",
            default="service_introspection",
            choices=list(_SOURCES),
            help="Whose events tell of the requests (default: %(default)s)",
        )
        parser.add_argument(
            "--progress-bar-update-rate",
            type=int,
            default=3,
            metavar="HZ",
            help="How often the progress is shown on a terminal; 0 for not at all (default: %(default)s)",
        )
        parser.add_argument(
            "--log-level",
            default="info",
            choices=["debug", "info", "warn", "error", "fatal"],
            help="Logging level (default: %(default)s)",
        )

    def main(self, *, args: Namespace) -> Status:
        """Play to the end or Ctrl-C."""
        from rosbag2_py import Player

        bags, options = common.bags_to_play(args), play_options(args)
        try:
            player = Player(bags, options, args.log_level)
        except (BagError, ValueError) as fault:
            raise common.error(str(fault)) from None
        return run(player)


def _add_selection(parser: ArgumentParser) -> None:
    parser.add_argument(
        "-e", "--regex", default="", help="Play only topics and services whose names contain the regular expression"
    )
    parser.add_argument(
        "-x", "--exclude-regex", default="", help="Do not play topics and services that contain the regular expression"
    )
    parser.add_argument("--exclude-topics", default=[], nargs="+", metavar="topic", help="Topics not to be played")
    parser.add_argument(
        "--exclude-services", default=[], nargs="+", metavar="service", help="Services not to be played"
    )


def _add_timing(parser: ArgumentParser) -> None:
    parser.add_argument(
        "-r", "--rate", type=check_positive_float, default=1.0, help="How fast to play (default: %(default)s)"
    )
    parser.add_argument("-l", "--loop", action="store_true", help="Begin again at the end, until Ctrl-C")
    parser.add_argument("-p", "--start-paused", action="store_true", help="Start paused")
    parser.add_argument(
        "-d",
        "--delay",
        type=check_positive_float,
        default=0.0,
        metavar="SECONDS",
        help="Wait so long before playing, each time where it loops",
    )
    common.add_start_offset(parser)
    parser.add_argument(
        "--playback-duration",
        type=float,
        default=-1.0,
        metavar="SECONDS",
        help="Play so much of the bag; negative for no limit (default: %(default)s)",
    )
    until = parser.add_mutually_exclusive_group()
    until.add_argument(
        "--playback-until-sec",
        type=float,
        default=-1.0,
        metavar="SECONDS",
        help="Play up to this time of the bag; negative for no limit",
    )
    until.add_argument(
        "--playback-until-nsec",
        type=int,
        default=-1,
        metavar="NANOSECONDS",
        help="Play up to this time of the bag; negative for no limit",
    )


def _add_clock(parser: ArgumentParser) -> None:
    parser.add_argument(
        "--clock",
        type=check_positive_float,
        nargs="?",
        const=40,
        default=0,
        metavar="HZ",
        help="Publish the bag's time on /clock so often (%(const)s Hz where no number is given)",
    )
    topics = parser.add_mutually_exclusive_group()
    topics.add_argument(
        "--clock-topics",
        default=[],
        nargs="+",
        metavar="topic",
        help="Publish the bag's time on /clock with each message of these topics",
    )
    topics.add_argument(
        "--clock-topics-all", action="store_true", help="Publish the bag's time on /clock with each message"
    )


def play_options(args: Namespace) -> PlayOptions:
    """Return the options of the arguments; CliError for invalid ones."""
    from rosbag2_py import PlayOptions, ServiceRequestsSource

    until = args.playback_until_nsec
    if args.playback_until_sec >= 0:
        until = round(args.playback_until_sec * 1e9)
    return PlayOptions(
        read_ahead_queue_size=args.read_ahead_queue_size,
        rate=args.rate,
        topics_to_filter=args.topics,
        services_to_filter=args.services,
        regex_to_filter=args.regex,
        exclude_regex_to_filter=args.exclude_regex,
        exclude_topics_to_filter=args.exclude_topics,
        exclude_service_events_to_filter=args.exclude_services,
        topic_qos_profile_overrides=read_overrides(args.qos_profile_overrides_path),
        loop=args.loop,
        topic_remapping_options=common.remapping_arguments(args.remap),
        clock_publish_frequency=args.clock,
        clock_publish_on_topic_publish=args.clock_topics_all,
        clock_topics=args.clock_topics,
        delay=args.delay,
        playback_duration=args.playback_duration,
        playback_until_timestamp=until,
        start_paused=args.start_paused,
        start_offset=args.start_offset,
        disable_keyboard_controls=args.disable_keyboard_controls,
        wait_acked_timeout=args.wait_for_all_acked,
        publish_service_requests=args.publish_service_requests,
        service_requests_source=ServiceRequestsSource[_SOURCES[args.service_requests_source]],
        progress_bar_update_rate=args.progress_bar_update_rate,
    )


def run(player: Player, burst: int | None = None) -> Status:
    """Play to the end or Ctrl-C, starting with a burst of a number of messages if given."""
    with common.ShutdownRequest(player.interrupt) as ending:
        try:
            player.start_spin()
            player.play()
            if burst is not None and not ending.asked:
                player.burst(burst)
            while not (ending.asked or player.wait_for_playback_to_finish(common.POLL_S)):
                continue
            return 1 if player.error else 0  # The node has said why.
        finally:
            player.stop()
            player.stop_spin()
