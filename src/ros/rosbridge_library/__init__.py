"""Messages as JSON, in the way of rosbridge: `internal.message_conversion` and `internal.ros_loader`."""
