"""The browser that the tests of this folder share."""

from collections.abc import Iterator

import pytest

from browser.cdp import Chromium, require_chromium, require_page


@pytest.fixture(scope="module")
def browser(request: pytest.FixtureRequest) -> Iterator[Chromium]:
    """A browser, its window as large as the module's `WINDOW` says."""
    require_chromium()
    require_page()
    with Chromium(*request.module.WINDOW) as browser:
        yield browser
