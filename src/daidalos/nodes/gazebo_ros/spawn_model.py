"""`spawn_model`: ROS 1's program that adds a robot or model to the running simulation."""

from __future__ import annotations

from daidalos.nodes.gazebo_ros.spawn_entity import spawn
from daidalos.nodes.runner import UserError, program_arguments, run_program

_RENAMED = {"-model": "-entity", "-param": "-topic"}
_IGNORED = ("-urdf", "-sdf", "-trimesh", "-gazebo")


def translate(arguments: list[str]) -> tuple[list[str], dict[str, float]]:
    """Return the arguments of ``spawn_entity.py``, and where joints begin (``-J joint position``).

    Raises
    ------
    UserError
    """
    translated: list[str] = []
    joints: dict[str, float] = {}
    rest = list(arguments)
    while rest:
        word = rest.pop(0)
        if word == "-J":
            try:
                name, position = rest.pop(0), rest.pop(0)
                joints[name] = float(position)
            except (IndexError, ValueError):
                raise UserError("-J takes the name of a joint and a number") from None
        elif word not in _IGNORED:
            translated.append(_RENAMED.get(word, word))
    return translated, joints


def main() -> int:
    """Run the program."""

    def body() -> None:
        arguments, joints = translate(program_arguments())
        spawn(arguments, joints, prog="spawn_model")

    return run_program(body, interrupted=130)
