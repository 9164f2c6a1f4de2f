"""Panels and displays of installed packages: which there are, and which of their files are served."""

from __future__ import annotations

import asyncio
from pathlib import Path

import aiohttp
import pytest
from yarl import URL

from daidalos.common.extensions import BUILT_IN, describe, listing
from daidalos.studio import extensions, typescript
from daidalos.studio.extensions import DISPLAYS, PANELS, PageModule, module_file, page_modules
from daidalos.studio.server import StudioServer

from .memory_source import MemorySource
from .page_packages import Install, make_package

PANEL_GROUP = "daidalos.studio_panels"


@pytest.fixture
def gauge(install: Install, tmp_path: Path) -> Path:
    files = {
        "gauge.js": "// A round gauge.\nexport default 1;\n",
        "parts/needle.js": "",
        "secret.py": "",
        ".hidden.js": "",
    }
    make_package(tmp_path, "gauges_of_test", files)
    install("gauges", PANEL_GROUP, {"gauge": "gauges_of_test:gauge.js"})
    return tmp_path / "gauges_of_test"


def test_modules_are_listed_with_where_they_are_served(gauge: Path) -> None:
    assert page_modules().panels == (PageModule("gauge", "gauges 1.0", "extensions/studio_panel/gauge/gauge.js"),)
    assert page_modules().displays == ()


def test_the_registry_lists_them_without_importing_anything(gauge: Path) -> None:
    (panel,) = (each for each in listing(PANELS) if each.origin != BUILT_IN)
    assert (panel.name, panel.origin, describe(panel)) == ("gauge", "gauges 1.0", "A round gauge")
    assert all(each.origin == BUILT_IN for each in listing(DISPLAYS))


def test_the_registry_lists_the_pages_own() -> None:
    own = typescript.built_in()
    assert own["studio_panel"]["plot"] == "fields of messages over time, or over each other"
    assert {"Grid", "Map", "MarkerArray", "PointCloud2"} <= own["studio_display"].keys()
    for kind, pattern in (("studio_panel", "panels/*_panel.tsx"), ("studio_display", "displays/types/*.ts")):
        files = [path for path in (typescript.WEB / "src").glob(pattern) if ".test." not in path.name]
        assert len(own[kind]) == len(files)


def test_a_package_does_not_replace_a_panel_of_the_page(install: Install, monkeypatch, tmp_path: Path) -> None:
    (tmp_path / "built_in.json").write_text('{"studio_panel": {"plot": "curves"}, "studio_display": {}}')
    monkeypatch.setattr(extensions, "STATIC", tmp_path)
    install("plots", PANEL_GROUP, {"plot": "plots_of_test:plot.js"})
    assert [(each.name, each.origin) for each in listing(PANELS)] == [("plot", BUILT_IN)]
    assert page_modules().panels == ()


@pytest.mark.parametrize(
    ("value", "error"),
    [
        ("gauges_of_test:gauge", "expected package:file.js instead of gauges_of_test:gauge"),
        ("gauges_of_test:dial.js", "the package gauges_of_test has no file dial.js"),
        ("dials_of_test:dial.js", "there is no package dials_of_test"),
    ],
)
def test_a_module_that_is_not_there_is_listed_with_the_reason(
    gauge: Path, install: Install, value: str, error: str
) -> None:
    install("dials", PANEL_GROUP, {"dial": value})
    (dial,) = (module for module in page_modules().panels if module.name == "dial")
    assert (dial.url, dial.error) == (None, error)
    assert module_file("studio_panel", "dial", "dial.js") is None


def test_what_lies_below_the_folder_of_the_module_is_served(gauge: Path) -> None:
    assert module_file("studio_panel", "gauge", "gauge.js") == gauge / "gauge.js"
    assert module_file("studio_panel", "gauge", "parts/needle.js") == gauge / "parts" / "needle.js"


@pytest.mark.parametrize(
    "path",
    ["../outside.js", "parts/../../outside.js", "secret.py", ".hidden.js", "absent.js", "link.js", "C:/x.js", "parts"],
)
def test_nothing_else_is_served(gauge: Path, path: str) -> None:
    (gauge.parent / "outside.js").write_text("")
    (gauge / "link.js").symlink_to(gauge.parent / "outside.js")
    assert module_file("studio_panel", "gauge", path) is None


@pytest.mark.parametrize(("kind", "name"), [("studio_display", "gauge"), ("studio_panel", "dial"), ("verb", "gauge")])
def test_nothing_is_served_under_another_kind_or_name(gauge: Path, kind: str, name: str) -> None:
    assert module_file(kind, name, "gauge.js") is None


def test_the_server_serves_them_and_not_what_is_around_them(gauge: Path) -> None:
    async def run(url: str) -> None:
        async with aiohttp.ClientSession(url) as session:
            (panel,) = (await (await session.get("/extensions.json")).json())["panels"]
            answer = await session.get("/" + panel["url"])
            assert answer.status == 200
            assert answer.content_type == "text/javascript"
            assert "script-src 'self'" in answer.headers["Content-Security-Policy"]
            for path in ("secret.py", "%2e%2e/outside.js", "..%2foutside.js"):
                missing = await session.get(URL(f"{url}extensions/studio_panel/gauge/{path}", encoded=True))
                assert missing.status == 404
            foreign = await session.get("/extensions.json", headers={"Origin": "https://elsewhere.example"})
            assert foreign.status == 403

    (gauge.parent / "outside.js").write_text("")
    with StudioServer(MemorySource(), port=0) as server:
        asyncio.run(run(server.url))
