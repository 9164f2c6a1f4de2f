"""Type variables under the names by which typed programs import them from `rclpy`."""

from __future__ import annotations

from typing import TypeVar

MsgType = TypeVar("MsgType")
SrvType = TypeVar("SrvType")
SrvTypeRequest = TypeVar("SrvTypeRequest")
SrvTypeResponse = TypeVar("SrvTypeResponse")
