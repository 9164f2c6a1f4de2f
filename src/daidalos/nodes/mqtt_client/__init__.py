"""Bridge between ROS topics and MQTT topics."""
