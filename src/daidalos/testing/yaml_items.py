"""Scenarios of YAML files as tests of pytest."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from daidalos.common.errors import UserError
from daidalos.testing.documents import Document, read_scenario


class ScenarioFile(pytest.File):
    """YAML file with one scenario."""

    def collect(self) -> Iterator[pytest.Item]:
        """Yield the scenario."""
        try:
            document = read_scenario(self.path)
        except UserError as error:
            raise self.CollectError(str(error)) from None
        item: ScenarioItem = ScenarioItem.from_parent(self, name=document.name, document=document)
        yield item


class ScenarioItem(pytest.Item):
    """Scenario of a YAML file."""

    def __init__(self, *, document: Document, **options: Any) -> None:
        super().__init__(**options)
        self._document = document
        self.add_marker(pytest.mark.scenario(timeout=document.timeout, seed=document.seed, pictures=document.pictures))

    def runtest(self) -> None:
        """Run it; this is in the process of the scenario."""
        from daidalos.testing.present import present
        from daidalos.testing.steps import Performance

        scenario = present()
        if scenario is None:
            raise UserError("a scenario runs in a process of its own")
        Performance(scenario, self._document).run()
        scenario.check()

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """Return what has failed, without a traceback."""
        from daidalos.testing.scenario import ScenarioFailure

        if isinstance(excinfo.value, ScenarioFailure | UserError):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Any, int | None, str]:
        """Return where it is."""
        return self.path, 0, self.name
