"""Build task of packages of build type ament_cmake."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import Any

from colcon_core.environment import create_environment_scripts
from colcon_core.event.output import StderrLine, StdoutLine
from colcon_core.logging import colcon_logger
from colcon_core.plugin_system import satisfies_version
from colcon_core.python_install_path import get_python_install_path
from colcon_core.shell import create_environment_hook, get_command_environment
from colcon_core.task import TaskExtensionPoint, run

from daidalos.workspaces.colcon.identification import TYPES

_logger = colcon_logger.getChild(__name__)


class CmakePackageBuildTask(TaskExtensionPoint):  # type: ignore[misc]
    """Build task of a package of build type ament_cmake, or of ROS 1, without CMake."""

    def __init__(self) -> None:
        super().__init__()
        satisfies_version(TaskExtensionPoint.EXTENSION_POINT_VERSION, "^1.0")

    async def build(self) -> int:
        """Build and install the package; returns the exit status."""
        from daidalos.workspaces import package_build
        from daidalos.workspaces.compiling import SkippedTarget, summary
        from daidalos.workspaces.errors import WorkspaceError

        package, args = self.context.pkg, self.context.args
        try:
            environment = await get_command_environment("build", args.build_base, self.context.dependencies)
        except RuntimeError as error:
            _logger.error(str(error))
            return 1
        place = _place(args, package.type)
        loop = asyncio.get_running_loop()
        try:
            build = await loop.run_in_executor(None, package_build.begin, place, arguments(args))
            if build.needs_cmake:
                status = await self._build_by_cmake(build, place, environment)
                if status:
                    return status
            for compilation in list(build.compilations):
                completed = await run(self.context, compilation.command, cwd=args.path, env=environment)
                if completed.returncode:
                    return int(completed.returncode)
            needs = sorted(dependency.name for dependency in package.get_dependencies(categories=["run"]))
            await loop.run_in_executor(None, package_build.finish, build, place, package.name, needs, environment)
        except WorkspaceError as error:
            self._post(StderrLine, str(error))
            return 1
        for note in build.contents.notes:
            self._post(StdoutLine, note)
        tests = [SkippedTarget(name, "a test in C++") for name in build.contents.left_out_tests]
        line = summary([*build.left_out, *tests])
        if line:
            self._post(StderrLine, f"{package.name}: {line}")
        self._create_environment(build.contents.hooks)
        return 0

    async def _build_by_cmake(self, build: Any, place: Any, environment: dict[str, str]) -> int:
        """Build and install the C++ targets by CMake; those that cannot be built stay left out."""
        from daidalos.workspaces import cmake_build

        package = self.context.pkg
        depends = sorted(dependency.name for dependency in package.get_dependencies(categories=["build"]))
        task = cmake_build.Task(package.name, depends, arguments(self.context.args), environment)
        loop = asyncio.get_running_loop()
        commands = await loop.run_in_executor(
            None, cmake_build.begin, build, place, task, lambda line: self._post(StdoutLine, line)
        )
        for command in commands:
            completed = await run(self.context, command, cwd=place.build, env=environment, capture_output=True)
            if completed.returncode:
                said = cmake_build.explain(completed)
                if said:
                    self._post(StderrLine, f"{package.name}: {said}")
                return int(completed.returncode)
        return 0

    def _post(self, kind: type, line: str) -> None:
        # Bytes, as from a program: colcon's own `print` posts text, which not every listener can take.
        self.context.put_event_into_queue(kind(f"{line}\n".encode()))

    def _create_environment(self, hooks: list[str]) -> None:
        package, args = self.context.pkg, self.context.args
        prefix = Path(args.install_base)
        own = create_environment_hook(
            "ament_prefix_path", prefix, package.name, "AMENT_PREFIX_PATH", "", mode="prepend"
        )
        create_environment_scripts(package, args, additional_hooks=[*own, *(str(prefix / hook) for hook in hooks)])


def arguments(args: Any) -> list[str]:
    """Return the command line's arguments for CMake."""
    return [*(getattr(args, "cmake_args", None) or []), *(getattr(args, "ament_cmake_args", None) or [])]


def _place(args: Any, package_type: str) -> Any:
    from daidalos.workspaces.package_build import Place

    python_folder = get_python_install_path("purelib", {"base": args.install_base, "platbase": args.install_base})
    return Place(
        source=Path(args.path),
        build=Path(args.build_base),
        prefix=Path(args.install_base),
        python_folder=Path(python_folder).relative_to(args.install_base).as_posix(),
        symlink=args.symlink_install,
        catkin=package_type == TYPES["catkin"],
    )
