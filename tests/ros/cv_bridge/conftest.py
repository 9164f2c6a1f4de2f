"""With OpenCV and without it."""

from collections.abc import Iterator
from types import ModuleType

import pytest
from cv_bridge import _opencv, compression, conversions, encodings


@pytest.fixture(params=["numpy", "opencv"])
def engine(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    """What converts; OpenCV only where it is installed."""
    if request.param == "opencv":
        pytest.importorskip("cv2")
    else:
        without_opencv(monkeypatch)
    encodings._shift.cache_clear()
    yield request.param
    encodings._shift.cache_clear()


@pytest.fixture
def no_opencv(monkeypatch: pytest.MonkeyPatch) -> None:
    """As if it were not installed."""
    without_opencv(monkeypatch)


def without_opencv(monkeypatch: pytest.MonkeyPatch) -> None:
    modules: tuple[ModuleType, ...] = (_opencv, compression, conversions, encodings)
    for module in modules:
        monkeypatch.setattr(module, "opencv", lambda: None)
