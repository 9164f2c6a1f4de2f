"""Bindings to the C library of the `cyclonedds` package.

The package's own Python layer encodes messages itself and holds the interpreter's lock while a write is blocked;
here messages are bytes already, so the library's functions for serialized samples are called directly.
"""

from __future__ import annotations

import ctypes as c
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from daidalos.transport.environment import EnvironmentVariableError

ENTITY = c.c_int32
HANDLE = c.c_uint64
DURATION = c.c_int64

INFINITE = 2**63 - 1
RETCODE_TIMEOUT = -10
RETCODE_PRECONDITION_NOT_MET = -4
DATA_AVAILABLE_STATUS = 1 << 8
PUBLICATION_MATCHED_STATUS = 1 << 11
ANY_STATE = 0
ALIVE = 16
SERDATA_DATA = 2

BUILTIN_PARTICIPANT = 0x7FFF0001
BUILTIN_PUBLICATION = 0x7FFF0003
BUILTIN_SUBSCRIPTION = 0x7FFF0004


class DdsError(OSError):
    """Failed call of the library; the message names the call and its return code."""


class SampleInfo(c.Structure):
    """``dds_sample_info_t``."""

    _fields_ = (
        ("sample_state", c.c_int),
        ("view_state", c.c_int),
        ("instance_state", c.c_int),
        ("valid_data", c.c_bool),
        ("source_timestamp", c.c_int64),
        ("instance_handle", HANDLE),
        ("publication_handle", HANDLE),
        ("disposed_generation_count", c.c_uint32),
        ("no_writers_generation_count", c.c_uint32),
        ("sample_rank", c.c_uint32),
        ("generation_rank", c.c_uint32),
        ("absolute_generation_rank", c.c_uint32),
    )


class Guid(c.Structure):
    """``dds_guid_t``."""

    _fields_ = (("v", c.c_ubyte * 16),)


class BuiltinParticipant(c.Structure):
    """``dds_builtintopic_participant_t``."""

    _fields_ = (("key", Guid), ("qos", c.c_void_p))


class BuiltinEndpoint(c.Structure):
    """``dds_builtintopic_endpoint_t``."""

    _fields_ = (
        ("key", Guid),
        ("participant_key", Guid),
        ("participant_handle", HANDLE),
        ("topic_name", c.c_char_p),
        ("type_name", c.c_char_p),
        ("qos", c.c_void_p),
    )


class TypeMeta(c.Structure):
    """``struct dds_type_meta_ser``."""

    _fields_ = (("data", c.c_void_p), ("size", c.c_uint32))


class TopicDescriptor(c.Structure):
    """``dds_topic_descriptor_t``."""

    _fields_ = (
        ("size", c.c_uint32),
        ("align", c.c_uint32),
        ("flags", c.c_uint32),
        ("keys_count", c.c_uint32),
        ("type_name", c.c_char_p),
        ("keys", c.c_void_p),
        ("ops_count", c.c_uint32),
        ("ops", c.POINTER(c.c_uint32)),
        ("meta", c.c_char_p),
        ("type_information", TypeMeta),
        ("type_mapping", TypeMeta),
        ("representations", c.c_uint32),
        ("member_table_offset", c.c_uint32),
    )


_LENGTH = ("length", c.c_ulong if sys.platform == "win32" else c.c_size_t)


def _vector(base: tuple[str, Any]) -> tuple[tuple[str, Any], ...]:
    return (_LENGTH, base) if sys.platform == "win32" else (base, _LENGTH)


class IoVector(c.Structure):
    """``ddsrt_iovec_t`` of the platform, for a buffer that the library returns."""

    _fields_ = _vector(("base", c.c_void_p))


class Buffer(c.Structure):
    """``ddsrt_iovec_t`` for a buffer that is passed in: bytes or an address."""

    _fields_ = _vector(("base", c.c_char_p))


class MatchedStatus(c.Structure):
    """``dds_publication_matched_status_t``."""

    _fields_ = (
        ("total_count", c.c_uint32),
        ("total_count_change", c.c_int32),
        ("current_count", c.c_uint32),
        ("current_count_change", c.c_int32),
        ("last_handle", HANDLE),
    )


_COUNT = {"win32": c.c_ulong, "darwin": c.c_int}.get(sys.platform, c.c_size_t)
"""Type of the number of a message's buffers on this system."""

_QOS, _PTR, _STR, _INT = c.c_void_p, c.c_void_p, c.c_char_p, c.c_int
_BLOCKING: dict[str, tuple[Any, tuple[Any, ...]]] = {
    "dds_create_domain": (ENTITY, (c.c_uint32, _STR)),
    "dds_create_participant": (ENTITY, (c.c_uint32, _QOS, _PTR)),
    "dds_create_topic": (ENTITY, (ENTITY, c.POINTER(TopicDescriptor), _STR, _QOS, _PTR)),
    "dds_create_reader": (ENTITY, (ENTITY, ENTITY, _QOS, _PTR)),
    "dds_create_writer": (ENTITY, (ENTITY, ENTITY, _QOS, _PTR)),
    "dds_create_waitset": (ENTITY, (ENTITY,)),
    "dds_create_guardcondition": (ENTITY, (ENTITY,)),
    "dds_delete": (c.c_int32, (ENTITY,)),
    "dds_waitset_wait": (c.c_int32, (ENTITY, _PTR, c.c_size_t, DURATION)),
    "dds_writecdr": (c.c_int32, (ENTITY, _PTR)),
    "dds_wait_for_acks": (c.c_int32, (ENTITY, DURATION)),
}
"""Functions that may take their time: others may use the interpreter meanwhile."""

_QUICK: dict[str, tuple[Any, tuple[Any, ...]]] = {
    "dds_strretcode": (_STR, (c.c_int32,)),
    "dds_create_qos": (_QOS, ()),
    "dds_delete_qos": (None, (_QOS,)),
    "dds_qset_history": (None, (_QOS, _INT, c.c_int32)),
    "dds_qset_reliability": (None, (_QOS, _INT, DURATION)),
    "dds_qset_durability": (None, (_QOS, _INT)),
    "dds_qset_durability_service": (
        None,
        (_QOS, DURATION, _INT, c.c_int32, c.c_int32, c.c_int32, c.c_int32),
    ),
    "dds_qset_resource_limits": (None, (_QOS, c.c_int32, c.c_int32, c.c_int32)),
    "dds_qset_deadline": (None, (_QOS, DURATION)),
    "dds_qset_lifespan": (None, (_QOS, DURATION)),
    "dds_qset_liveliness": (None, (_QOS, _INT, DURATION)),
    "dds_qset_userdata": (None, (_QOS, _PTR, c.c_size_t)),
    "dds_qset_ignorelocal": (None, (_QOS, _INT)),
    "dds_qset_writer_data_lifecycle": (None, (_QOS, c.c_bool)),
    "dds_set_qos": (c.c_int32, (ENTITY, _QOS)),
    "dds_get_participant": (ENTITY, (ENTITY,)),
    "dds_qget_history": (c.c_bool, (_QOS, _PTR, _PTR)),
    "dds_qget_reliability": (c.c_bool, (_QOS, _PTR, _PTR)),
    "dds_qget_durability": (c.c_bool, (_QOS, _PTR)),
    "dds_qget_deadline": (c.c_bool, (_QOS, _PTR)),
    "dds_qget_lifespan": (c.c_bool, (_QOS, _PTR)),
    "dds_qget_liveliness": (c.c_bool, (_QOS, _PTR, _PTR)),
    "dds_qget_userdata": (c.c_bool, (_QOS, c.POINTER(_PTR), c.POINTER(c.c_size_t))),
    "dds_free": (None, (_PTR,)),
    "dds_get_guid": (c.c_int32, (ENTITY, c.POINTER(Guid))),
    "dds_get_instance_handle": (c.c_int32, (ENTITY, c.POINTER(HANDLE))),
    "dds_get_entity_sertype": (c.c_int32, (ENTITY, c.POINTER(_PTR))),
    "dds_set_status_mask": (c.c_int32, (ENTITY, c.c_uint32)),
    "dds_waitset_attach": (c.c_int32, (ENTITY, ENTITY, c.c_ssize_t)),
    "dds_waitset_detach": (c.c_int32, (ENTITY, ENTITY)),
    "dds_set_guardcondition": (c.c_int32, (ENTITY, c.c_bool)),
    "dds_take": (c.c_int32, (ENTITY, c.POINTER(_PTR), c.POINTER(SampleInfo), c.c_size_t, c.c_uint32)),
    "dds_return_loan": (c.c_int32, (ENTITY, c.POINTER(_PTR), c.c_int32)),
    "dds_takecdr": (c.c_int32, (ENTITY, c.POINTER(_PTR), c.c_uint32, c.POINTER(SampleInfo), c.c_uint32)),
    "dds_get_matched_subscriptions": (c.c_int32, (ENTITY, c.POINTER(HANDLE), c.c_size_t)),
    "dds_get_matched_publication_data": (c.POINTER(BuiltinEndpoint), (ENTITY, HANDLE)),
    "dds_get_matched_subscription_data": (c.POINTER(BuiltinEndpoint), (ENTITY, HANDLE)),
    "dds_builtintopic_free_endpoint": (None, (c.POINTER(BuiltinEndpoint),)),
    "dds_get_publication_matched_status": (c.c_int32, (ENTITY, c.POINTER(MatchedStatus))),
    "ddsi_serdata_from_ser_iov": (_PTR, (_PTR, _INT, _COUNT, _PTR, c.c_size_t)),
    "ddsi_serdata_size": (c.c_uint32, (_PTR,)),
    "ddsi_serdata_to_ser_ref": (_PTR, (_PTR, c.c_size_t, c.c_size_t, c.POINTER(IoVector))),
    "ddsi_serdata_to_ser_unref": (None, (_PTR, c.POINTER(IoVector))),
    "ddsi_serdata_unref": (None, (_PTR,)),
}
"""Functions that return at once: giving up the interpreter for them would cost more than they do."""


class Library:
    """Functions of the library under their own names."""

    def __init__(self, path: Path) -> None:
        self.path = path
        for loader, functions in ((c.CDLL, _BLOCKING), (c.PyDLL, _QUICK)):
            library = loader(str(path))
            for name, (result, arguments) in functions.items():
                function = getattr(library, name)
                function.restype, function.argtypes = result, arguments
                setattr(self, name, function)

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(f"{name} is not among the functions taken from {self.path.name}")

    def check(self, result: int, what: str) -> int:
        """Return a call's result; raise DdsError if it is an error code.

        Raises
        ------
        DdsError
            When it is an error, saying `what` was asked.
        """
        if result < 0:
            raise DdsError(f"DDS could not {what}: {self.dds_strretcode(result).decode()}")
        return result


_loaded: Library | None = None


def load() -> Library:
    """Return the library of the installed `cyclonedds` package without importing the package.

    Raises
    ------
    EnvironmentVariableError
        When the package is not installed, with the command that installs it.
    """
    global _loaded
    if _loaded is None:
        package = find_spec("cyclonedds")
        folders = package.submodule_search_locations if package is not None else None
        locator = Path(next(iter(folders or ("",)))) / "__library__.py"
        if not folders or not locator.is_file():
            raise EnvironmentVariableError(
                "RMW_IMPLEMENTATION is 'rmw_cyclonedds_cpp', which needs the package cyclonedds: "
                "pip install 'daidalos[dds]'"
            )
        scope: dict[str, Any] = {"__file__": str(locator)}
        exec(compile(locator.read_text(encoding="utf-8"), str(locator), "exec"), scope)
        _loaded = Library(Path(scope["library_path"]))
    return _loaded
