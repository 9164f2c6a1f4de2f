"""Type hashes."""

from __future__ import annotations

_SIZE = 32


class TypeHash:
    """The hash of an interface's definition (REP 2016).

    Parameters
    ----------
    version
        1 for RIHS01; -1 where there is no hash.
    value
        32 bytes.
    """

    __slots__ = ("_value", "_version")

    def __init__(self, version: int = -1, value: bytes = bytes(_SIZE)) -> None:
        self.version = version
        self.value = value

    @classmethod
    def from_text(cls, text: str) -> TypeHash:
        """Return the hash written as ``RIHS01_...``; one without a hash where `text` is something else."""
        prefix, _, digits = text.partition("_")
        if not prefix.startswith("RIHS") or len(digits) != 2 * _SIZE:
            return cls()
        return cls(int(prefix[4:]), bytes.fromhex(digits))

    @property
    def version(self) -> int:
        """Version of the hash's definition."""
        return self._version

    @version.setter
    def version(self, value: int) -> None:
        assert isinstance(value, int)
        self._version = value

    @property
    def value(self) -> bytes:
        """The hash's 32 bytes."""
        return self._value

    @value.setter
    def value(self, value: bytes) -> None:
        assert isinstance(value, bytes)
        self._value = value

    def __eq__(self, other: object) -> bool:
        return isinstance(other, TypeHash) and (self._version, self._value) == (other._version, other._value)

    __hash__ = None  # type: ignore[assignment]

    def __str__(self) -> str:
        if self._version <= 0 or len(self._value) != _SIZE:
            return "INVALID"
        return f"RIHS{self._version:02}_{self._value.hex()}"

    def __repr__(self) -> str:
        return f"TypeHash(version={self._version}, value={self._value!r})"
