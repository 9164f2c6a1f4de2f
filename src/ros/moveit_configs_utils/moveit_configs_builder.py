"""Builder of MoveIt's parameters."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Self

from ament_index_python.packages import get_package_share_path
from launch_param_builder import ParameterBuilder, ParameterBuilderFileNotFoundError, load_xacro, load_yaml
from launch_ros.parameter_descriptions import ParameterValue

from moveit_configs_utils.substitutions import Xacro

_CONFIG = Path("config")
_CONTROLLERS = "_controllers.yaml"
_PLANNING = "_planning.yaml"

logger = logging.getLogger(__name__)


@dataclass(slots=True)
class MoveItConfigs:
    """Parameters of MoveIt by subject.

    Attributes
    ----------
    package_path
        Share folder of the robot's configuration package.
    move_group_capabilities
        Capabilities to load and to leave out, as text.
    """

    package_path: Path | None = None
    robot_description: dict[str, Any] = field(default_factory=dict)
    robot_description_semantic: dict[str, Any] = field(default_factory=dict)
    robot_description_kinematics: dict[str, Any] = field(default_factory=dict)
    planning_pipelines: dict[str, Any] = field(default_factory=dict)
    trajectory_execution: dict[str, Any] = field(default_factory=dict)
    planning_scene_monitor: dict[str, Any] = field(default_factory=dict)
    sensors_3d: dict[str, Any] = field(default_factory=dict)
    move_group_capabilities: dict[str, Any] = field(
        default_factory=lambda: {"capabilities": "", "disable_capabilities": ""}
    )
    joint_limits: dict[str, Any] = field(default_factory=dict)
    moveit_cpp: dict[str, Any] = field(default_factory=dict)
    pilz_cartesian_limits: dict[str, Any] = field(default_factory=dict)

    def to_dict(self) -> dict[str, Any]:
        """Return all parameters by name."""
        parts = (
            self.robot_description,
            self.robot_description_semantic,
            self.robot_description_kinematics,
            self.planning_pipelines,
            self.trajectory_execution,
            self.planning_scene_monitor,
            self.sensors_3d,
            self.joint_limits,
            self.moveit_cpp,
        )
        parameters = {name: value for part in parts for name, value in part.items()}
        for name, limits in self.pilz_cartesian_limits.items():
            parameters[name] = {**(parameters.get(name) or {}), **(limits or {})}
        return parameters


class MoveItConfigsBuilder(ParameterBuilder):
    """Builder of MoveIt's parameters, whose methods load a subject each and return the builder.

    What is not loaded explicitly is loaded from where MoveIt's assistant writes it. Paths of files are absolute or
    begin at the share folder of the robot's configuration package.

    Parameters
    ----------
    robot_name
        The robot.
    robot_description
        Name of the parameter with its description.
    package_name
        Its configuration package; ``<robot_name>_moveit_config`` where None.
    """

    def __init__(
        self, robot_name: str, robot_description: str = "robot_description", package_name: str | None = None
    ) -> None:
        super().__init__(package_name or f"{robot_name}_moveit_config")
        self.__configs = MoveItConfigs(package_path=self._package_path)
        self.__robot_name = robot_name
        self.__description = robot_description
        self.__urdf: Path | None = None
        self.__urdf_arguments: dict[str, str] | None = None
        self.__srdf: Path | None = None
        modified = self._package_path / _CONFIG / f"{robot_name}.urdf.xacro"
        if modified.exists():
            self.__urdf = modified
        self.__read_assistant_file()
        if self.__urdf is None:
            self.__urdf = self._package_path / _CONFIG / f"{robot_name}.urdf"
            logger.warning("Cannot infer URDF from `%s`. -- using config/%s.urdf", self._package_path, robot_name)
        if self.__srdf is None:
            self.__srdf = _CONFIG / f"{robot_name}.srdf"
            logger.warning("Cannot infer SRDF from `%s`. -- using config/%s.srdf", self._package_path, robot_name)

    def __read_assistant_file(self) -> None:
        """Read where MoveIt's assistant found URDF and SRDF."""
        file = self._package_path / ".setup_assistant"
        if not file.exists():
            return
        config = (load_yaml(file) or {}).get("moveit_setup_assistant_config", {})
        urdf = config.get("urdf", config.get("URDF"))
        if urdf:
            if self.__urdf is None:
                self.__urdf = get_package_share_path(urdf["package"]) / urdf["relative_path"]
            words = (urdf.get("xacro_args") or "").split()
            if words:
                self.__urdf_arguments = dict(word.split(":=", 1) for word in words)
        srdf = config.get("srdf", config.get("SRDF"))
        if srdf:
            self.__srdf = Path(srdf["relative_path"])

    def __xml(self, path: Path, mappings: Mapping[Any, Any] | None) -> Any:
        """Return what xacro makes of a file, at once or, with substitutions among `mappings`, at the launch."""
        if all(isinstance(text, str) for pair in (mappings or {}).items() for text in pair):
            return load_xacro(path, mappings)
        return ParameterValue(Xacro(str(path), mappings=mappings), value_type=str)

    def __file(self, file_path: str | Path | None, default: str) -> Path:
        return self._package_path / (file_path or _CONFIG / default)

    def robot_description(self, file_path: str | None = None, mappings: Mapping[Any, Any] | None = None) -> Self:
        """Load the URDF, with these arguments of xacro; without the file it is taken from its topic."""
        path = self._package_path / file_path if file_path else self.__urdf
        assert path is not None
        try:
            content = self.__xml(path, mappings or self.__urdf_arguments)
        except ParameterBuilderFileNotFoundError as error:
            logger.warning("%s: the robot description will be loaded from /robot_description topic", error)
            return self
        self.__configs.robot_description = {self.__description: content}
        return self

    def robot_description_semantic(
        self, file_path: str | None = None, mappings: Mapping[Any, Any] | None = None
    ) -> Self:
        """Load the SRDF, with these arguments of xacro."""
        path = self._package_path / (file_path or self.__srdf or "")
        self.__configs.robot_description_semantic = {f"{self.__description}_semantic": self.__xml(path, mappings)}
        return self

    def robot_description_kinematics(self, file_path: str | None = None) -> Self:
        """Load the solvers of inverse kinematics, by default from config/kinematics.yaml."""
        content = load_yaml(self.__file(file_path, "kinematics.yaml"))
        self.__configs.robot_description_kinematics = {f"{self.__description}_kinematics": content}
        return self

    def joint_limits(self, file_path: str | None = None) -> Self:
        """Load the limits of joints, by default from config/joint_limits.yaml."""
        content = load_yaml(self.__file(file_path, "joint_limits.yaml"))
        self.__configs.joint_limits = {f"{self.__description}_planning": content}
        return self

    def moveit_cpp(self, file_path: str | None = None) -> Self:
        """Load the parameters of MoveItCpp, by default from config/moveit_cpp.yaml."""
        self.__configs.moveit_cpp = load_yaml(self.__file(file_path, "moveit_cpp.yaml"))
        return self

    def trajectory_execution(self, file_path: str | None = None, moveit_manage_controllers: bool = True) -> Self:
        """Load the controllers that execute trajectories.

        Parameters
        ----------
        file_path
            The file; by default the only ``config/*_controllers.yaml``, or that of moveit or the robot.
        moveit_manage_controllers
            Whether MoveIt may switch controllers.

        Raises
        ------
        RuntimeError
            When there are several files and none of these names.
        """
        self.__configs.trajectory_execution = {"moveit_manage_controllers": moveit_manage_controllers}
        path = self._package_path / file_path if file_path else self.__controllers_file()
        if path is not None:
            self.__configs.trajectory_execution.update(load_yaml(path) or {})
        return self

    def __controllers_file(self) -> Path | None:
        folder = self._package_path / _CONFIG
        names = _names(folder, _CONTROLLERS)
        if not names:
            logger.warning("trajectory_execution: there is no file %s/*%s", folder, _CONTROLLERS)
            return None
        preferred = [name for name in ("moveit", "moveit2", self.__robot_name) if name in names]
        if len(names) > 1 and not preferred:
            options = "\n - ".join(f"{name}{_CONTROLLERS}" for name in names)
            raise RuntimeError(
                f"trajectory_execution: Unable to guess which parameter file to load. Options:\n - {options}"
            )
        return folder / f"{names[0] if len(names) == 1 else preferred[0]}{_CONTROLLERS}"

    def planning_scene_monitor(
        self,
        publish_planning_scene: bool = True,
        publish_geometry_updates: bool = True,
        publish_state_updates: bool = True,
        publish_transforms_updates: bool = True,
        publish_robot_description: bool = False,
        publish_robot_description_semantic: bool = False,
    ) -> Self:
        """Set what the monitor of the planning scene publishes."""
        self.__configs.planning_scene_monitor = {
            "publish_planning_scene": publish_planning_scene,
            "publish_geometry_updates": publish_geometry_updates,
            "publish_state_updates": publish_state_updates,
            "publish_transforms_updates": publish_transforms_updates,
            "publish_robot_description": publish_robot_description,
            "publish_robot_description_semantic": publish_robot_description_semantic,
        }
        return self

    def sensors_3d(self, file_path: str | None = None) -> Self:
        """Load the sensors of the planning scene, by default from config/sensors_3d.yaml, if there are any."""
        path = self.__file(file_path, "sensors_3d.yaml")
        content = load_yaml(path) if path.exists() else None
        if content and any(content.get("sensors") or ()):
            self.__configs.sensors_3d = content
        return self

    def planning_pipelines(
        self, default_planning_pipeline: str | None = None, pipelines: list[str] | None = None, load_all: bool = True
    ) -> Self:
        """Load planning pipelines from ``config/<pipeline>_planning.yaml`` or MoveIt's defaults.

        Parameters
        ----------
        default_planning_pipeline
            The default one; ``ompl`` or else the first where None.
        pipelines
            The pipelines; those with a file where None.
        load_all
            Whether those for which MoveIt has defaults are among them.

        Raises
        ------
        RuntimeError
            When the default one is not among them, or there are none.
        """
        folder = self._package_path / _CONFIG
        defaults = get_package_share_path("moveit_configs_utils") / "default_configs"
        if pipelines is None:
            pipelines = _names(folder, _PLANNING)
            if load_all:
                pipelines += [name for name in _names(defaults, _PLANNING) if name not in pipelines]
        if not default_planning_pipeline and pipelines:
            default_planning_pipeline = "ompl" if "ompl" in pipelines else pipelines[0]
        if default_planning_pipeline not in pipelines:
            raise RuntimeError(
                f"default_planning_pipeline: `{default_planning_pipeline}` doesn't name any of the input pipelines "
                f"`{','.join(pipelines)}`"
            )
        loaded: dict[str, Any] = {
            "planning_pipelines": pipelines,
            "default_planning_pipeline": default_planning_pipeline,
        }
        for name in pipelines:
            own = folder / f"{name}{_PLANNING}"
            loaded[name] = load_yaml(own if own.exists() else defaults / f"{name}{_PLANNING}") or {}
        if "ompl" in loaded and "planner_configs" not in loaded["ompl"]:
            loaded["ompl"].update(load_yaml(defaults / "ompl_defaults.yaml"))
        self.__configs.planning_pipelines = loaded
        return self

    def pilz_cartesian_limits(self, file_path: str | None = None) -> Self:
        """Load the limits in space of the Pilz planner, by default from config/pilz_cartesian_limits.yaml."""
        content = load_yaml(self.__file(file_path, "pilz_cartesian_limits.yaml"))
        self.__configs.pilz_cartesian_limits = {f"{self.__description}_planning": content}
        return self

    def to_moveit_configs(self) -> MoveItConfigs:
        """Return the parameters by subject; what was not loaded is loaded now."""
        configs = self.__configs
        for name in (
            "robot_description",
            "robot_description_semantic",
            "robot_description_kinematics",
            "planning_pipelines",
            "trajectory_execution",
            "planning_scene_monitor",
            "sensors_3d",
            "joint_limits",
        ):
            if not getattr(configs, name):
                getattr(self, name)()
        if "pilz_industrial_motion_planner" in configs.planning_pipelines and not configs.pilz_cartesian_limits:
            try:
                self.pilz_cartesian_limits()
            except ParameterBuilderFileNotFoundError as error:
                logger.warning("The Pilz planner has no limits: %s", error)
        return configs

    def to_dict(self, include_moveit_configs: bool = True) -> dict[str, Any]:
        """Return the parameters by name, with those of MoveIt by default."""
        if include_moveit_configs:
            self._parameters.update(self.to_moveit_configs().to_dict())
        return self._parameters


def _names(folder: Path, ending: str) -> list[str]:
    """Return the names before an ending of the files in a folder, sorted."""
    return sorted(path.name.removesuffix(ending) for path in folder.glob(f"?*{ending}") if path.is_file())
