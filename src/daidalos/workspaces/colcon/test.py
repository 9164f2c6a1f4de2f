"""Test task of packages of build type ament_cmake."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from colcon_core.event.test import TestFailure
from colcon_core.logging import colcon_logger
from colcon_core.plugin_system import satisfies_version
from colcon_core.shell import get_command_environment
from colcon_core.task import TaskExtensionPoint, run

_logger = colcon_logger.getChild(__name__)


class CmakePackageTestTask(TaskExtensionPoint):  # type: ignore[misc]
    """Test task that runs the Python tests of a package of build type ament_cmake."""

    def __init__(self) -> None:
        super().__init__()
        satisfies_version(TaskExtensionPoint.EXTENSION_POINT_VERSION, "^1.0")

    async def test(self) -> int:
        """Run the tests; return the exit status, which is 0 even if tests failed."""
        from daidalos.workspaces.package_tests import NO_TESTS, read_tests

        args = self.context.args
        try:
            environment = await get_command_environment("test", args.build_base, self.context.dependencies)
            tests = read_tests(Path(args.build_base))
        except RuntimeError as error:
            _logger.error(str(error))
            return 1
        except FileNotFoundError:
            _logger.error(f"Package '{self.context.pkg.name}' has not been built: build it before it is tested")
            return 1
        statuses = [await self._run_test(test, environment) for test in tests]
        if any(status not in (0, NO_TESTS) for status in statuses):
            self.context.put_event_into_queue(TestFailure(self.context.pkg.name))
        return 0

    async def _run_test(self, test: Any, environment: dict[str, str]) -> int:
        from daidalos.workspaces.package_tests import command, complete_result

        package, args = self.context.pkg.name, self.context.args
        results = Path(args.test_result_base or args.build_base) / "test_results" / package
        results.mkdir(parents=True, exist_ok=True)
        result = results / f"{test.name}.xunit.xml"
        result.unlink(missing_ok=True)
        environment = {**environment, **dict(test.environment), "PYTHONDONTWRITEBYTECODE": "1"}
        words = command(test, package, result, Path(args.build_base))
        completed = await run(self.context, words, cwd=test.folder or args.build_base, env=environment)
        complete_result(result, package, test, completed.returncode)
        return int(completed.returncode)
