"""Launch descriptions that spawn controllers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from launch import LaunchDescription, SomeSubstitutionsType, Substitution
from launch.actions import DeclareLaunchArgument
from launch.substitutions import IfElseSubstitution, LaunchConfiguration
from launch_ros.actions import Node

_File = str | Substitution
_Files = _File | Sequence[_File] | None


def generate_controllers_spawner_launch_description(
    controller_names: Sequence[str],
    controller_params_files: Sequence[_File] | None = None,
    extra_spawner_args: Sequence[str] | None = None,
) -> LaunchDescription:
    """Return what spawns controllers, and unloads them at the end where its argument ``unload_on_kill`` says so.

    Parameters
    ----------
    controller_names
        Their names; all are given to one spawner.
    controller_params_files
        YAML files with their types and parameters; what the controller manager knows itself needs none.
    extra_spawner_args
        Further arguments of the spawner, such as ``["--inactive"]``.

    Returns
    -------
    LaunchDescription
        Its arguments are ``controller_manager_name`` and ``unload_on_kill``.
    """
    manager, unload = LaunchConfiguration("controller_manager_name"), LaunchConfiguration("unload_on_kill")
    files = [word for file in controller_params_files or () if file for word in ("--param-file", file)]
    words: list[SomeSubstitutionsType] = [
        *controller_names,
        "--controller-manager",
        manager,
        *files,
        IfElseSubstitution(unload, "--unload-on-kill", ""),
        *(extra_spawner_args or ()),
    ]
    # The shell leaves out the word that is empty without `unload_on_kill`.
    spawner = Node(package="controller_manager", executable="spawner", arguments=words, shell=True, output="screen")
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "controller_manager_name", default_value="controller_manager", description="who loads the controllers"
            ),
            DeclareLaunchArgument(
                "unload_on_kill", default_value="false", description="whether the spawner waits, and unloads them"
            ),
            spawner,
        ]
    )


def generate_controllers_spawner_launch_description_from_dict(
    controller_info_dict: Mapping[str, _Files], extra_spawner_args: Sequence[str] | None = None
) -> LaunchDescription:
    """Return what spawns controllers; each name has a parameter file, several or None.

    See `generate_controllers_spawner_launch_description`.
    """
    files = [file for value in controller_info_dict.values() for file in _listed(value)]
    return generate_controllers_spawner_launch_description(
        list(controller_info_dict), list(dict.fromkeys(files)), extra_spawner_args
    )


def generate_load_controller_launch_description(
    controller_name: str, controller_params_file: _Files = None, extra_spawner_args: Sequence[str] | None = None
) -> LaunchDescription:
    """Return what spawns one controller; see `generate_controllers_spawner_launch_description`."""
    return generate_controllers_spawner_launch_description(
        [controller_name], _listed(controller_params_file), extra_spawner_args
    )


def _listed(files: _Files) -> list[_File]:
    if files is None:
        return []
    return [files] if isinstance(files, str | Substitution) else list(files)
