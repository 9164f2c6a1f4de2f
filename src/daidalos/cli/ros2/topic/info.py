"""`ros2 topic info`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2cli.node.strategy import add_arguments as add_graph_arguments

from daidalos.cli.ros2.completion import complete_topics
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.graph import absolute, topics, types_of
from daidalos.cli.ros2.graph_view import graph_view
from daidalos.common.suggestions import did_you_mean
from daidalos.transport.graph import EndpointInfo, EndpointKind


class InfoVerb(Verb):
    """Print information about a topic."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        complete_topics(parser.add_argument("topic_name", help="Name of the ROS topic to get info (e.g. '/chatter')"))
        parser.add_argument(
            "--verbose",
            "-v",
            action="store_true",
            help="Prints detailed information like the node name, node namespace, topic type, topic type hash, GUID, "
            "and QoS Profile of the publishers and subscribers to this topic",
        )

    def main(self, *, args: Namespace) -> Status:
        """Print the type, the publishers and the subscriptions."""
        name = absolute(args.topic_name)
        with graph_view(args) as graph:
            known = topics(graph)
            publishers = graph.endpoints(EndpointKind.PUBLISHER, name=name)
            subscriptions = graph.endpoints(EndpointKind.SUBSCRIPTION, name=name)
        types = types_of(known, name)
        if not types:
            return f"Unknown topic '{args.topic_name}'{did_you_mean(name, (other for other, _ in known))}"
        print(f"Type: {types[0] if len(types) == 1 else types}")
        if not args.verbose:
            print(f"Publisher count: {len(publishers)}")
            print(f"Subscription count: {len(subscriptions)}")
            return 0
        print(f"\nPublisher count: {len(publishers)}\n")
        _print_endpoints(publishers)
        print(f"Subscription count: {len(subscriptions)}\n")
        _print_endpoints(subscriptions)
        return 0


def _print_endpoints(endpoints: list[EndpointInfo]) -> None:
    from rclpy.topic_endpoint_info import TopicEndpointInfo

    for endpoint in endpoints:
        print(f"{TopicEndpointInfo.from_endpoint(endpoint)}\n")
