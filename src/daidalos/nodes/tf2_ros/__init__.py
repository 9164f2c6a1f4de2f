"""Publishers, monitors and servers of transforms."""

COMPONENTS = {"StaticTransformBroadcasterNode": "static_transform_publisher:StaticTransformBroadcasterNode"}
