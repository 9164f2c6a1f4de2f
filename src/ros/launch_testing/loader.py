"""The tests of a file that describes a launch: one run for each set of parameters."""

from __future__ import annotations

import functools
import inspect
import unittest
from collections.abc import Callable, Iterable, Iterator
from types import ModuleType
from typing import Any

from launch import LaunchDescription, LaunchDescriptionEntity

from .actions import ReadyToTest
from .ready_aggregator import ReadyAggregator


def slim_formatwarning(msg: Any, *args: Any, **kwargs: Any) -> str:
    """Return a warning without the line of code that caused it."""
    return f"Warning: {msg}\n"


class TestRun:
    """One launch and its tests.

    Parameters
    ----------
    name
        Of the file.
    test_description_function
        Returns the launch description, or it with a dictionary of names for the tests' arguments.
    param_args
        The parameters of this run.
    pre_shutdown_tests, post_shutdown_tests
        The tests that run with the processes, and those that run after these have ended.
    """

    __test__ = False

    def __init__(
        self,
        name: str,
        test_description_function: Callable[..., Any],
        param_args: dict[str, Any],
        pre_shutdown_tests: unittest.TestSuite,
        post_shutdown_tests: unittest.TestSuite,
    ) -> None:
        self.name = name
        if param_args:
            shown = ", ".join(f"{key}={value}" for key, value in param_args.items())
            self.name = f"{name}[{shown}]"
        self.test_description_function = test_description_function
        self.param_args = param_args
        self.pre_shutdown_tests = pre_shutdown_tests
        self.post_shutdown_tests = post_shutdown_tests
        # Known to the results' files, too.
        for case in self.all_cases():
            name_in_run = f"{case._testMethodName}{self._suffix()}"
            case._testMethodName_in_run = name_in_run  # type: ignore[attr-defined]  # our own

    def _suffix(self) -> str:
        return self.name[self.name.index("[") :] if self.param_args else ""

    @property
    def markers(self) -> dict[str, Any]:
        """The marks of the test description."""
        return getattr(self.test_description_function, "__markers__", {})

    def bind(
        self,
        tests: unittest.TestSuite,
        injected_attributes: dict[str, Any] | None = None,
        injected_args: dict[str, Any] | None = None,
    ) -> None:
        """Bind the arguments that tests ask for.

        Parameters
        ----------
        tests
            The tests.
        injected_attributes
            Set on every test case.
        injected_args
            Passed to those test methods that have arguments of these names.
        """
        for test in _flatten(tests):
            for name, value in (injected_attributes or {}).items():
                setattr(test, name, value)
            _bind_arguments(test, injected_args or {})

    def normalized_test_description(self, ready_fn: Callable[[], None]) -> tuple[LaunchDescription, dict[str, Any]]:
        """Return the launch description and the names for the tests' arguments.

        Parameters
        ----------
        ready_fn
            Called when the description's `ReadyToTest` actions have all been executed.

        Raises
        ------
        RuntimeError
            If there is no such action, or if the test description returns something else.
        """
        function = self.test_description_function
        takes_ready_fn = "ready_fn" in inspect.signature(function).parameters
        result = function(ready_fn=ready_fn) if takes_ready_fn else function()
        description, context = result if isinstance(result, tuple) else (result, {})
        if not (isinstance(description, LaunchDescription) and isinstance(context, dict)):
            raise RuntimeError(
                "a test description must return a LaunchDescription, or it with a dictionary, "
                f"but it returned {description!r} and {context!r}"
            )
        if not takes_ready_fn:
            actions = list(dict.fromkeys(_ready_to_test_actions([description])))
            if not actions:
                raise RuntimeError(
                    "generate_test_description functions without a ready_fn argument must return a "
                    "LaunchDescription containing a ReadyToTest action"
                )
            aggregator = ReadyAggregator(ready_fn, len(actions))
            for action in actions:
                action._add_callback(aggregator.ready_fn)
        return description, context

    def get_launch_description(self) -> LaunchDescription:
        """Return the launch description alone."""
        return self.normalized_test_description(ready_fn=lambda: None)[0]

    def all_cases(self) -> Iterator[unittest.TestCase]:
        """Yield all test cases."""
        yield from _flatten(self.pre_shutdown_tests)
        yield from _flatten(self.post_shutdown_tests)

    def __str__(self) -> str:
        return self.name


def LoadTestsFromPythonModule(module: ModuleType, *, name: str = "launch_tests") -> list[TestRun]:
    """Return the runs that a module describes.

    Parameters
    ----------
    module
        Has a function `generate_test_description` and test cases.
    name
        Of the module, for people.
    """
    describe = module.generate_test_description
    runs = describe() if hasattr(describe, "__parametrized__") else [(describe, {})]
    return [
        TestRun(
            name=name,
            test_description_function=function,
            param_args=arguments,
            pre_shutdown_tests=PreShutdownTestLoader().loadTestsFromModule(module),
            post_shutdown_tests=PostShutdownTestLoader().loadTestsFromModule(module),
        )
        for function, arguments in runs
    ]


def PreShutdownTestLoader() -> unittest.TestLoader:
    """Return a loader of the tests that run with the processes."""
    return _Loader(post_shutdown=False)


def PostShutdownTestLoader() -> unittest.TestLoader:
    """Return a loader of the tests that run after the processes have ended."""
    return _Loader(post_shutdown=True)


class _Loader(unittest.TestLoader):
    """Loader that loads those test classes of a module that run at one of the two times."""

    def __init__(self, *, post_shutdown: bool) -> None:
        super().__init__()
        self._post_shutdown = post_shutdown

    def loadTestsFromTestCase(self, testCaseClass: type[unittest.TestCase]) -> unittest.TestSuite:
        if getattr(testCaseClass, "__post_shutdown_test__", False) == self._post_shutdown:
            return super().loadTestsFromTestCase(testCaseClass)
        return unittest.TestSuite()


def _flatten(tests: Any) -> Iterator[unittest.TestCase]:
    if isinstance(tests, Iterable):
        for test in tests:
            yield from _flatten(test)
    elif tests is not None:
        yield tests


def _bind_arguments(test: unittest.TestCase, arguments: dict[str, Any]) -> None:
    if isinstance(test, unittest.loader._FailedTest):  # type: ignore[attr-defined]  # not in typeshed
        return
    for name in ("setUp", "tearDown", test._testMethodName):
        method = getattr(test, name)
        wanted = {key for key in inspect.signature(method).parameters if key in arguments}
        if wanted:
            setattr(test, name, _partial(method, {key: arguments[key] for key in wanted}))
    # Class-wide set-up is the class's own, so it gets its arguments there.
    for name in ("setUpClass", "tearDownClass"):
        method = getattr(test, name)
        wanted = {key for key in inspect.signature(method).parameters if key in arguments}
        if wanted:
            setattr(type(test), name, staticmethod(_partial(method, {key: arguments[key] for key in wanted})))


def _partial(method: Callable[..., Any], arguments: dict[str, Any]) -> Callable[..., Any]:
    partial = functools.partial(method, **arguments)
    functools.update_wrapper(partial, method)
    return partial


def _ready_to_test_actions(entities: Any) -> Iterator[ReadyToTest]:
    for entity in entities:
        if isinstance(entity, ReadyToTest):
            yield entity
        if isinstance(entity, LaunchDescriptionEntity):
            yield from _ready_to_test_actions(entity.describe_sub_entities())
            for _, sub_entities in entity.describe_conditional_sub_entities():
                yield from _ready_to_test_actions(sub_entities)
