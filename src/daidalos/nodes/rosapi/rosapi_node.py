"""`rosapi_node`: questions to the graph as services, for clients of rosbridge that are not nodes themselves."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from typing import Any

from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node
from rclpy.task import Future as RclpyFuture
from rosapi import objectutils, proxy
from rosapi.glob_helper import Globs, any_match, split_globs
from rosapi_msgs import srv
from rosapi_msgs.msg import TypeDef

from daidalos.common.documents import DocumentError, parse_yaml
from daidalos.common.parameters import Parameters, parameter
from daidalos.distribution import DISTRIBUTION
from daidalos.nodes.graph_parameters import GraphParameters
from daidalos.nodes.parameters import declare
from daidalos.nodes.runner import run
from daidalos.studio.source import Parameter, SourceError


@dataclass(frozen=True)
class RosapiNodeParameters(Parameters):
    """Parameters of ``rosapi_node``."""

    topics_glob: str = parameter("[*]", "Patterns of topics that clients may see, as ``[/a, /b/*]``.", read_only=True)
    services_glob: str = parameter("[*]", "Patterns of services that clients may see.", read_only=True)
    params_glob: str = parameter("[*]", "Patterns of parameters that clients may see and set.", read_only=True)


class RosapiNode(Node):
    """Node with the services of ``/rosapi``."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("rosapi", **kwargs)
        p = declare(self, RosapiNodeParameters)
        self._globs = Globs(*(split_globs(text) for text in (p.topics_glob, p.services_glob, p.params_glob)))
        self._others = GraphParameters(self)
        self._group = ReentrantCallbackGroup()
        proxy.init(self)
        for kind, name, answer in (
            (srv.Topics, "topics", self._topics),
            (srv.TopicsForType, "topics_for_type", self._topics_for_type),
            (srv.TopicsAndRawTypes, "topics_and_raw_types", self._topics_and_raw_types),
            (srv.Services, "services", self._services),
            (srv.ServicesForType, "services_for_type", self._services_for_type),
            (srv.Nodes, "nodes", self._nodes),
            (srv.NodeDetails, "node_details", self._node_details),
            (srv.GetActionServers, "action_servers", self._action_servers),
            (srv.TopicType, "topic_type", self._topic_type),
            (srv.ServiceType, "service_type", self._service_type),
            (srv.Publishers, "publishers", self._publishers_of),
            (srv.Subscribers, "subscribers", self._subscribers_of),
            (srv.ServiceProviders, "service_providers", self._service_providers),
            (srv.ServiceNode, "service_node", self._service_node),
            (srv.MessageDetails, "message_details", self._message_details),
            (srv.ServiceRequestDetails, "service_request_details", self._service_request_details),
            (srv.ServiceResponseDetails, "service_response_details", self._service_response_details),
            (srv.SetParam, "set_param", self._set_param),
            (srv.GetParam, "get_param", self._get_param),
            (srv.HasParam, "has_param", self._has_param),
            (srv.DeleteParam, "delete_param", self._delete_param),
            (srv.GetParamNames, "get_param_names", self._get_param_names),
            (srv.GetTime, "get_time", self._get_time),
            (srv.GetROSVersion, "get_ros_version", self._get_ros_version),
        ):
            self.create_service(kind, f"/rosapi/{name}", answer, callback_group=self._group)

    # Topics, services and nodes.

    def _topics(self, request: Any, response: Any) -> Any:
        response.topics, response.types = proxy.get_topics_and_types(self._globs.topics)
        return response

    def _topics_for_type(self, request: Any, response: Any) -> Any:
        response.topics = proxy.get_topics_for_type(request.type, self._globs.topics)
        return response

    def _topics_and_raw_types(self, request: Any, response: Any) -> Any:
        self._topics(request, response)
        response.typedefs_full_text = [objectutils.get_typedef_full_text(kind) for kind in response.types]
        return response

    def _topic_type(self, request: Any, response: Any) -> Any:
        response.type = proxy.get_topic_type(request.topic, self._globs.topics)
        return response

    def _publishers_of(self, request: Any, response: Any) -> Any:
        response.publishers = proxy.get_publishers(request.topic, self._globs.topics)
        return response

    def _subscribers_of(self, request: Any, response: Any) -> Any:
        response.subscribers = proxy.get_subscribers(request.topic, self._globs.topics)
        return response

    def _services(self, request: Any, response: Any) -> Any:
        response.services = proxy.get_services(self._globs.services)
        return response

    def _services_for_type(self, request: Any, response: Any) -> Any:
        response.services = proxy.get_services_for_type(request.type, self._globs.services)
        return response

    def _service_type(self, request: Any, response: Any) -> Any:
        response.type = proxy.get_service_type(request.service, self._globs.services)
        return response

    def _service_providers(self, request: Any, response: Any) -> Any:
        response.providers = proxy.get_service_providers(request.service, self._globs.services)
        return response

    def _service_node(self, request: Any, response: Any) -> Any:
        response.node = proxy.get_service_node(request.service, self._globs.services)
        return response

    def _nodes(self, request: Any, response: Any) -> Any:
        response.nodes = proxy.get_nodes()
        return response

    def _node_details(self, request: Any, response: Any) -> Any:
        response.subscribing, response.publishing, response.services = proxy.get_node_info(request.node)
        return response

    def _action_servers(self, request: Any, response: Any) -> Any:
        topics = proxy.get_topics(self._globs.topics, include_hidden=True)
        response.action_servers = proxy.filter_action_servers(topics)
        return response

    # Definitions.

    def _message_details(self, request: Any, response: Any) -> Any:
        response.typedefs = [TypeDef(**one) for one in objectutils.get_typedef_recursive(request.type)]
        return response

    def _service_request_details(self, request: Any, response: Any) -> Any:
        return self._service_details(objectutils.get_service_request_typedef_recursive, request, response)

    def _service_response_details(self, request: Any, response: Any) -> Any:
        return self._service_details(objectutils.get_service_response_typedef_recursive, request, response)

    def _service_details(self, find: Any, request: Any, response: Any) -> Any:
        try:
            response.typedefs = [TypeDef(**one) for one in find(request.type)]
        except Exception as error:  # what a client asks for is not a service
            self.get_logger().warning(f"no definition of {request.type!r:.100}: {error}")
        return response

    # Parameters.

    async def _get_param(self, request: Any, response: Any) -> Any:
        found = await self._find(request.name)
        value = _default(request.default_value) if found is None else found.value
        response.value = json.dumps(value)
        return response

    async def _has_param(self, request: Any, response: Any) -> Any:
        found = await self._find(request.name)
        response.exists = found is not None and found.value is not None
        return response

    async def _set_param(self, request: Any, response: Any) -> Any:
        name = self._full_name(request.name)
        if name is not None:
            try:
                value = parse_yaml(request.value, "value")
            except DocumentError as error:
                self.get_logger().warning(f"set_param {request.name!r:.100}: {error}")
            else:
                await self._change(name, value)
        return response

    async def _delete_param(self, request: Any, response: Any) -> Any:
        name = self._full_name(request.name)
        if name is not None:
            await self._change(name, None)
        return response

    async def _get_param_names(self, request: Any, response: Any) -> Any:
        found = await self._done(self._others.get([]))
        names = [name.replace(".", ":", 1) for name in sorted(one.name for one in found)]
        response.names = [name for name in names if self._may_see(name)]
        return response

    def _may_see(self, name: str) -> bool:
        return any_match(name, self._globs.params) or any_match(name.partition(":")[2], self._globs.params)

    def _full_name(self, name: str) -> str | None:
        """Return a parameter ``/node:name`` as ``/node.name``; None, with a warning, where it has no such form."""
        node, colon, inner = name.partition(":")
        if not colon or not node or not inner:
            self.get_logger().warning(f"parameter {name!r:.100}: expected NODE:PARAMETER, such as /sim:rate")
            return None
        node = f"/{node.lstrip('/')}"
        if not self._may_see(f"{node}:{inner}"):
            self.get_logger().warning(f"parameter {name!r:.100} matches none of 'params_glob'")
            return None
        return f"{node}.{inner}"

    async def _find(self, name: str) -> Parameter | None:
        full = self._full_name(name)
        found = [] if full is None else await self._done(self._others.get([full]))
        return next((one for one in found if one.name == full), None)

    async def _change(self, name: str, value: Any) -> None:
        await self._done(self._others.set([Parameter(name, value)]))

    async def _done(self, future: Future[Sequence[Parameter]]) -> Sequence[Parameter]:
        """Wait for parameters; none where nobody answers, which is logged."""
        over = RclpyFuture(executor=self.executor)
        future.add_done_callback(lambda _: over.set_result(None))
        await over
        try:
            return future.result()
        except SourceError as error:
            self.get_logger().warning(str(error))
            return []

    # Time and version.

    def _get_time(self, request: Any, response: Any) -> Any:
        response.time = self.get_clock().now().to_msg()
        return response

    def _get_ros_version(self, request: Any, response: Any) -> Any:
        response.version = 2
        response.distro = os.environ.get("ROS_DISTRO", DISTRIBUTION)
        return response


def _default(text: str) -> Any:
    try:
        return json.loads(text) if text else ""
    except ValueError:
        return text


def main() -> int:
    """Run the node."""
    return run(RosapiNode)
