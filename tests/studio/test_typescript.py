"""The page's types: generated from the interface definitions and from the server's own records."""

import dataclasses
import json
from pathlib import Path

import pytest

from daidalos.studio import protocol, typescript
from daidalos.studio.frames import CLIENT_LAYOUTS, SERVER_LAYOUTS
from daidalos.studio.typescript import GENERATED, GenerationError, generate, write

OWN = {"protocol", "arrangement", "extensions", "definitions"}


def text_of(module: str, web: Path = typescript.WEB) -> str:
    return generate(web)[GENERATED / f"{module}.ts"]


@pytest.fixture
def web(tmp_path: Path) -> Path:
    (tmp_path / "src" / "panels").mkdir(parents=True)
    (tmp_path / "src" / "panels" / "scan.tsx").write_text(
        'import { type LaserScan, Range as Distance } from "../generated/sensor_msgs";\n'
        'import type { SetBool } from "../generated/std_srvs";\n'
        'import type { ServerMessage } from "../generated/protocol";\n'
    )
    return tmp_path


def test_only_what_the_page_imports_is_generated_with_what_it_refers_to(web):
    packages = {path.stem for path in generate(web)} - OWN
    assert packages == {"sensor_msgs", "std_srvs", "std_msgs", "builtin_interfaces"}
    scan = text_of("sensor_msgs", web)
    assert 'import type { Header } from "./std_msgs";' in scan
    assert "  ranges: Float32Array;" in scan
    assert "export const Range = {\n  ULTRASOUND: 0," in scan
    assert "PointCloud2" not in scan
    assert "Request: SetBool_Request;" in text_of("std_srvs", web)


def test_an_interface_that_does_not_exist_is_named_with_the_file(web):
    (web / "src" / "more.ts").write_text('import type { Scan } from "./generated/sensor_msgs";')
    with pytest.raises(GenerationError, match=r"more\.ts: there is no interface Scan in the package sensor_msgs"):
        generate(web)


def test_writing_removes_what_is_no_longer_generated(web):
    write(web)
    (web / "src" / "panels" / "scan.tsx").write_text("")
    write(web)
    assert {path.stem for path in (web / GENERATED).iterdir()} == OWN


@pytest.mark.parametrize(
    "record", [*protocol.ServerMessage.kinds.values(), *protocol.ClientMessage.kinds.values(), protocol.Channel]
)
def test_every_message_has_its_keys(record):
    text = text_of("protocol").partition(f"export interface {record.__name__} {{\n")[2].partition("}")[0]
    keys = [line.split()[1].rstrip(":?") for line in text.splitlines()]
    expected = [typescript.key_of(field.name) for field in dataclasses.fields(record)]
    assert keys == (["op", *expected] if hasattr(record, "op") else expected)


def test_frames_have_the_same_layout_on_both_sides():
    text = text_of("protocol")
    for name, layout in {**SERVER_LAYOUTS, **CLIENT_LAYOUTS}.items():
        told = json.loads(text.partition(f"export const {name} = ")[2].partition(" as const")[0])
        assert told.pop("opcode") == layout.opcode
        values = range(1, len(layout.offsets) + 1)
        frame = layout.pack(*values)
        assert told.pop("size") == len(frame)
        assert {field: frame[told[field]] for field in told if field != "speed"} == {
            field: value for field, value in zip(layout.offsets, values, strict=True) if field != "speed"
        }
