"""State that calls a service."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import rclpy
from rclpy.node import Node

from smach_ros.exchange import ExchangeState, Part

_POLL_S = 0.1


class ServiceState(ExchangeState):
    """State that calls a service: 'succeeded', 'aborted', 'preempted', or what `response_cb` returns.

    Parameters
    ----------
    node
        See `RosState`.
    service_name, service_spec
        The service and its class.
    request
        The request to begin with; one with default values where None.
    request_key
        Userdata with the request.
    request_slots
        Userdata with fields of the request, under their names.
    request_cb, request_cb_args, request_cb_kwargs
        Called with the userdata, the request and these arguments; changes the request or returns another one.
    response_key, response_slots
        Userdata for the response and for fields of it.
    response_cb, response_cb_args, response_cb_kwargs
        Called with the userdata, the response and these arguments; may return an outcome.
    input_keys, output_keys, outcomes
        Further ones; see `smach.State`.
    """

    def __init__(
        self,
        node: Node,
        service_name: str,
        service_spec: Any,
        request: Any = None,
        request_cb: Callable[..., Any] | None = None,
        request_cb_args: Sequence[Any] = (),
        request_cb_kwargs: Mapping[str, Any] | None = None,
        request_key: str | None = None,
        request_slots: Sequence[str] = (),
        response_cb: Callable[..., Any] | None = None,
        response_cb_args: Sequence[Any] = (),
        response_cb_kwargs: Mapping[str, Any] | None = None,
        response_key: str | None = None,
        response_slots: Sequence[str] = (),
        input_keys: Iterable[str] = (),
        output_keys: Iterable[str] = (),
        outcomes: Iterable[str] = (),
    ) -> None:
        super().__init__(node, ["succeeded", "aborted", "preempted", *outcomes], input_keys, output_keys)
        self._service_name = service_name
        self._request = service_spec.Request() if request is None else request
        self._filling = Part(
            self,
            "request",
            service_spec.Request,
            key=request_key,
            slots=request_slots,
            callback=request_cb,
            args=request_cb_args,
            keywords=request_cb_kwargs,
            is_input=True,
        )
        self._storing = Part(
            self,
            "response",
            service_spec.Response,
            key=response_key,
            slots=response_slots,
            callback=response_cb,
            args=response_cb_args,
            keywords=response_cb_kwargs,
            is_input=False,
        )
        self._client = node.create_client(service_spec, service_name)

    def execute(self, ud: Any) -> str:
        """Wait for the service and call it."""
        while not self._client.wait_for_service(_POLL_S):
            if self.preempt_requested():
                break
            if not rclpy.ok():
                return "aborted"
        if self.preempt_requested():
            self.service_preempt()
            return "preempted"
        request = self._filling.fill(ud, self._request)
        if request is None:
            return "aborted"
        try:
            response = self._client.call(request)
        except TypeError as error:
            self.node.get_logger().error(f"Exception when calling service '{self._service_name}': {error}")
            return "aborted"
        if response is None:
            return "aborted"
        done, outcome = self._storing.store(ud, response)
        return (outcome or "succeeded") if done else "aborted"
