"""Several robots with their poses, as one launch argument."""

from __future__ import annotations

import sys

from daidalos.common.documents import parse_yaml

_KEYS = ("x", "y", "z", "roll", "pitch", "yaw")


class ParseMultiRobotPose:
    """Parser of robots and their poses on the command line of a launch.

    They look like ``robots:="robot1={x: 1.0, y: 1.0, yaw: 1.57}; robot2={x: 1.0, y: 2.0}"``.

    Parameters
    ----------
    target_argument
        The name of the argument, such as ``robots``.
    """

    def __init__(self, target_argument: str) -> None:
        prefix = f"{target_argument}:="
        given = [argument.removeprefix(prefix) for argument in sys.argv[1:] if argument.startswith(prefix)]
        self.__argument = target_argument
        self.__text = given[-1] if given else ""

    def value(self) -> dict[str, dict[str, float]]:
        """Return the poses by the robots' names; a pose has x, y, z (m), roll, pitch and yaw (rad), 0 if not given.

        Raises
        ------
        ValueError
            If the argument is not of that form.
        """
        robots = (part.strip() for part in self.__text.split(";"))
        return dict(self.__read(robot) for robot in robots if robot)

    def __read(self, robot: str) -> tuple[str, dict[str, float]]:
        name, equals, text = robot.partition("=")
        try:
            pose = parse_yaml(text)
            if not (name.strip() and equals and isinstance(pose, dict) and pose.keys() <= set(_KEYS)):
                raise ValueError
            return name.strip(), {key: float(pose.get(key, 0.0)) for key in _KEYS}
        except (TypeError, ValueError):
            raise ValueError(
                f"the launch argument '{self.__argument}' has '{robot}', but a robot looks like "
                f"name={{x: 1.0, y: 2.0, yaw: 0.5}}, with {', '.join(_KEYS)}"
            ) from None
