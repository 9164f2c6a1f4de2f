"""What readers make of mutated files, frames and tokens: faults, the slowest input, and the growth of memory.

`DAIDALOS_FUZZ_INPUTS` says how many inputs are tried (20,000 by default; a million takes half an hour on two cores),
`DAIDALOS_FUZZ_SEED` with which random numbers. An input at fault is printed with its target.
"""

from __future__ import annotations

import contextlib
import io
import os
import random
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import psutil

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
from test_hostile_files import HOSTILE_JSON, HOSTILE_XML, HOSTILE_YAML, JSON, XML, YAML

INPUTS = int(os.environ.get("DAIDALOS_FUZZ_INPUTS", "20000"))
SEED = int(os.environ.get("DAIDALOS_FUZZ_SEED", "0"))
MAX_SEED_BYTES = 2_000
MAX_INPUT_BYTES = 4_000
BUILT_IN_ERRORS = ("builtins", "yaml", "xml", "pyexpat", "struct")
_PIECES = (
    b"${",
    b"}",
    b"&a",
    b"*a",
    b"<",
    b"/>",
    b"\x00",
    b"\xff",
    b"[",
    b"{",
    b"- ",
    b": ",
    b"9" * 30,
    b"-1",
    b"nan",
    b"\n",
)


@dataclass(frozen=True)
class Target:
    """A reader, with inputs to mutate and the errors that it may raise besides those of our own."""

    name: str
    read: Callable[[bytes], Any]
    seeds: tuple[bytes, ...]
    allowed: tuple[type[BaseException], ...] = ()


def run() -> dict[str, float]:
    """Measure."""
    source = random.Random(SEED)
    process = psutil.Process()
    faults, slowest = 0, 0.0
    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stderr(io.StringIO()):
        targets = [*_files(Path(folder)), *_texts()]
        for target in targets:
            _read(target, target.seeds[0])  # which loads what it needs
        before = process.memory_info().rss
        begun = time.monotonic()
        for number in range(INPUTS):
            target = targets[number % len(targets)]
            data = _mutated(source, target.seeds)
            started = time.process_time()
            fault = _read(target, data)
            taken = time.process_time() - started
            if fault is not None:
                faults += 1
                print(f"{target.name}: {fault}: {data!r}", file=sys.__stderr__, flush=True)
            if taken > slowest:
                slowest = taken
        elapsed = time.monotonic() - begun
        grown = process.memory_info().rss - before
    return {
        "fuzz.inputs": float(INPUTS),
        "fuzz.targets": float(len(targets)),
        "fuzz.faults": float(faults),
        "fuzz.slowest_s": slowest,
        "fuzz.memory_growth_mb": grown / 2**20,
        "fuzz.inputs_per_s": INPUTS / elapsed,
    }


def _read(target: Target, data: bytes) -> str | None:
    """Return what is wrong with the error that a reader raises, None where there is none or nothing is wrong."""
    try:
        target.read(data)
    except target.allowed:
        return None
    except Exception as error:
        kind, text = type(error), str(error)
        if kind.__module__.partition(".")[0] in BUILT_IN_ERRORS:
            return f"{kind.__name__}: {text[:200]}"
        if len(text.splitlines()) != 1 or len(text) > 2_000:
            return f"{kind.__name__}: a message of {len(text)} characters in {len(text.splitlines())} lines"
    return None


def _mutated(source: random.Random, seeds: tuple[bytes, ...]) -> bytes:
    data = bytearray(source.choice(seeds))
    for _ in range(source.randint(1, 6)):
        at = source.randint(0, len(data))
        match source.randrange(5):
            case 0:
                data[at : at + 1] = bytes([source.randrange(256)])
            case 1:
                del data[at : at + source.randint(1, 20)]
            case 2:
                data[at:at] = source.choice(_PIECES)
            case 3:
                piece = data[at : at + source.randint(1, 60)]
                data[at:at] = bytes(piece) * source.randint(1, 4)
            case 4:
                other = source.choice(seeds)
                start = source.randint(0, len(other))
                data[at:at] = other[start : start + source.randint(1, 60)]
    return bytes(data[:MAX_INPUT_BYTES])


def _files(folder: Path) -> list[Target]:
    """Return the readers of files, each with the hostile files of the tests and those of the built-in packages."""
    targets = []
    for readers, hostile in ((YAML, HOSTILE_YAML), (XML, HOSTILE_XML), (JSON, HOSTILE_JSON)):
        for kind, (read, name) in readers.items():
            seeds = [data for data in hostile.values() if 0 < len(data) < MAX_SEED_BYTES]
            place = folder / name / kind.replace(" ", "_")
            place.mkdir(parents=True)

            def read_file(data: bytes, read: Callable[[Path], Any] = read, path: Path = place / name) -> None:
                path.write_bytes(data)
                read(path)

            targets.append(Target(kind, read_file, (*seeds, *_built_in(Path(name).suffix))))
    return targets


def _built_in(suffix: str) -> list[bytes]:
    from daidalos.interfaces.library import BUILT_IN

    found = [path for path in sorted(BUILT_IN.rglob(f"*{suffix}")) if path.stat().st_size < MAX_SEED_BYTES]
    return [path.read_bytes() for path in found[:20]]


def _texts() -> list[Target]:
    """Return the readers of what arrives over the network or is typed."""
    from geometry_msgs.msg import PoseWithCovarianceStamped
    from rclpy.impl.parameter_file import parse_value
    from rclpy.serialization import deserialize_message, serialize_message
    from tf2_msgs.msg import TFMessage

    from daidalos.description.expressions import Evaluator
    from daidalos.interfaces.idl import read_idl
    from daidalos.interfaces.library import BUILT_IN
    from daidalos.interfaces.parser import parse
    from daidalos.studio.frames import parse_binary
    from daidalos.transport.zenoh.keys import parse_token

    def text(read: Callable[[str], Any]) -> Callable[[bytes], Any]:
        return lambda data: read(data.decode("utf-8", "replace"))

    def evaluate(expression: str) -> Any:
        evaluator = Evaluator()
        names = {"size": 0.5, "values": [3, 1], "str": str, "len": len, **evaluator.functions()}
        return evaluator.evaluate(expression, names)

    messages = tuple(path.read_bytes() for path in sorted((BUILT_IN / "geometry_msgs" / "msg").glob("*.msg")))
    token = b"@ros2_lv/0/ab/0/1/MP/%/%/talker/%chatter/std_msgs::msg::dds_::String_/RIHS01_ab/::,10:,:,:,,"
    pose = bytes(serialize_message(PoseWithCovarianceStamped()))
    python_errors = (ArithmeticError, AttributeError, LookupError, NameError, SyntaxError, TypeError, ValueError)
    return [
        Target(
            "message of a peer",
            lambda data: deserialize_message(data, TFMessage),
            (pose, b"\0\1\0\0\1\0\0\0"),
            (ValueError,),
        ),
        Target("token of a peer", text(parse_token), (token, b"@ros2_lv/0/ab/0/0/NN/%/%/talker")),
        Target("binary frame of a client", parse_binary, (b"\x01\0\0\0\0abc", b"\x02" + bytes(20))),
        Target("parameter on the command line", text(parse_value), (b"[1, 2]", b"{a: 1}", b"1e3"), (ValueError,)),
        Target("interface", text(lambda text: parse(text, "a", "msg", "A")), messages),
        Target(
            "IDL", text(lambda text: read_idl(text, "A")), (b"module a { module msg { struct A { long x; }; }; };",)
        ),
        Target(
            "expression", text(evaluate), (b"[v * 2 for v in values]", b"'{}'.format(size)", b"9**9"), python_errors
        ),
    ]
