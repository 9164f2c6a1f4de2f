"""AMCL: the pose of a robot in a known map."""

COMPONENTS = {"AmclNode": "amcl:AmclNode"}
