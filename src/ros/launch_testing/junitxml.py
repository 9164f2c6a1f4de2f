"""Results of tests as JUnit's XML."""

from __future__ import annotations

import unittest
import xml.etree.ElementTree as ET
from typing import Any
from unittest.util import strclass


def unittestResultsToXml(*, name: str = "launch_test", test_results: dict[str, Any] | None = None) -> ET.ElementTree:
    """Return the results of several runs as a document.

    Parameters
    ----------
    name
        Of the document.
    test_results
        The results by the runs' names.
    """
    results = test_results or {}
    suites = ET.Element("testsuites")
    suites.set("name", name)
    suites.set("time", f"{sum(_time(result) for result in results.values()):.3f}")
    suites.set("tests", str(sum(result.testsRun for result in results.values())))
    suites.set("failures", str(sum(len(result.failures) for result in results.values())))
    suites.set("errors", str(sum(len(result.errors) for result in results.values())))
    suites.extend(unittestResultToXml(str(run), result) for run, result in results.items())
    return ET.ElementTree(suites)


def unittestResultToXml(name: str, test_result: Any) -> ET.Element:
    """Return the results of one run as an element."""
    suite = ET.Element("testsuite")
    suite.set("name", name)
    suite.set("tests", str(test_result.testsRun))
    suite.set("failures", str(len(test_result.failures)))
    suite.set("errors", str(len(test_result.errors)))
    suite.set("skipped", str(len(test_result.skipped)))
    suite.set("time", f"{_time(test_result):.3f}")
    for case in test_result.testCases:
        suite.append(unittestCaseToXml(test_result, case))
    return suite


def unittestCaseToXml(test_result: Any, test_case: unittest.TestCase) -> ET.Element:
    """Return one test case with its result as an element."""
    element = ET.Element("testcase")
    element.set("classname", strclass(type(test_case)))
    element.set("name", getattr(test_case, "_testMethodName_in_run", test_case._testMethodName))
    element.set("time", f"{test_result.testTimes.get(test_case, 0.0):.3f}")
    for tag, outcomes in (
        ("failure", test_result.failures),
        ("error", test_result.errors),
        ("skipped", test_result.skipped),
    ):
        for case, message in outcomes:
            if case is test_case:
                ET.SubElement(element, tag).set("message", message)
    return element


def _time(test_result: Any) -> float:
    return float(sum(test_result.testTimes.values()))
