"""A session of ours, and one that speaks zenoh only."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from pathlib import Path

import pytest
import zenoh

from daidalos.transport.environment import Environment
from daidalos.transport.session import Session
from daidalos.transport.shared import make_backend


@pytest.fixture
def session(domain: int) -> Iterator[Session]:
    session = Session(make_backend(Environment(domain)))
    yield session
    session.close()


@pytest.fixture
def stranger(session: Session) -> Iterator[zenoh.Session]:
    """A zenoh session that knows only where ours listens."""
    folder = Path(os.environ["XDG_RUNTIME_DIR"]) / "daidalos" / "zenoh" / str(session.backend._domain)
    endpoints = json.loads(next(folder.glob("*.json")).read_text())
    config = zenoh.Config()
    for key, value in {
        "mode": "peer", "connect/endpoints": endpoints, "listen/endpoints": [], "timestamping/enabled": True,
        "scouting/multicast/enabled": False,
    }.items():  # fmt: skip
        config.insert_json5(key, json.dumps(value))
    stranger = zenoh.open(config)
    yield stranger
    stranger.close()
