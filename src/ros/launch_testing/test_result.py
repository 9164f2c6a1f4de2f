"""The results of tests, with the time that each took."""

from __future__ import annotations

import time
import unittest
from typing import Any

from .loader import TestRun


class TestResult(unittest.TextTestResult):
    """Results that remember their test cases and how long each took."""

    __test__ = False

    def __init__(self, stream: Any = None, descriptions: bool | None = None, verbosity: int | None = None) -> None:
        super().__init__(stream, bool(descriptions), 1 if verbosity is None else verbosity)
        self.__test_cases: list[unittest.TestCase] = []
        self.__starts: dict[unittest.TestCase, float] = {}
        self.__times: dict[unittest.TestCase, float] = {}

    @property
    def testCases(self) -> list[unittest.TestCase]:
        """The test cases in the order in which they ran."""
        return self.__test_cases

    @property
    def testTimes(self) -> dict[unittest.TestCase, float]:
        """The seconds that each took."""
        return self.__times

    def startTest(self, test: unittest.TestCase) -> None:
        """Start measuring a test."""
        self.__test_cases.append(test)
        self.__starts[test] = time.perf_counter()
        super().startTest(test)

    def stopTest(self, test: unittest.TestCase) -> None:
        """Stop measuring a test."""
        self.__times[test] = time.perf_counter() - self.__starts[test]
        super().stopTest(test)

    def append(self, results: TestResult) -> None:
        """Add other results to these."""
        self.failures += results.failures
        self.errors += results.errors
        self.testsRun += results.testsRun
        self.skipped += results.skipped
        self.expectedFailures += results.expectedFailures
        self.unexpectedSuccesses += results.unexpectedSuccesses
        self.__test_cases += results.testCases
        self.__times.update(results.testTimes)


class _NotRun(unittest.TestResult):
    """The results of a run that there was not."""

    def __init__(self, test_run: TestRun) -> None:
        super().__init__()
        self.__test_run = test_run

    @property
    def testCases(self) -> list[unittest.TestCase]:
        """The test cases."""
        return list(self.__test_run.all_cases())

    @property
    def testTimes(self) -> dict[unittest.TestCase, float]:
        """The seconds that each took: none."""
        return dict.fromkeys(self.testCases, 0.0)


class FailResult(_NotRun):
    """The results of a run that could not be made: all its tests failed.

    Parameters
    ----------
    test_run
        The run.
    message
        Why.
    """

    def __init__(self, test_run: TestRun, message: str) -> None:
        super().__init__(test_run)
        self.failures = [(case, message) for case in test_run.all_cases()]
        self.testsRun = len(self.failures)

    def wasSuccessful(self) -> bool:
        """Return that they failed."""
        return False


class SkipResult(_NotRun):
    """The results of a run that was not to be made: all its tests were skipped.

    Parameters
    ----------
    test_run
        The run.
    skip_reason
        Why.
    """

    def __init__(self, test_run: TestRun, skip_reason: str = "") -> None:
        super().__init__(test_run)
        self.skipped = [(case, skip_reason) for case in test_run.all_cases()]
        self.testsRun = len(self.skipped)

    def wasSuccessful(self) -> bool:
        """Return that none failed."""
        return True
