"""ROS domains for tests that run at the same time on one machine."""

from .impl import domain_id as domain_id
