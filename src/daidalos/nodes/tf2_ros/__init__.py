"""Transforms: publish them, look at them, serve them."""

COMPONENTS = {"StaticTransformBroadcasterNode": "static_transform_publisher:StaticTransformBroadcasterNode"}
