"""Parameter files that are wrong are refused in one line that says where."""

from pathlib import Path

import pytest
from rclpy.impl.parameter_file import ParameterFileError, parse_value, read_file

BOMB = "a: &a [1, 1, 1, 1, 1, 1, 1, 1]\n" + "".join(
    f"{chr(98 + number)}: &{chr(98 + number)} [{', '.join([f'*{chr(97 + number)}'] * 8)}]\n" for number in range(20)
)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (BOMB.encode(), "line 2, column 8: aliases are not supported"),
        (b"/**:\n  ros__parameters: &x\n    a: 1\n/b: *x\n", "line 4, column 5: aliases are not supported"),
        (b"/**:\n  ros__parameters:\n    a: \xff\xfe\n", "not valid UTF-8"),
        (b"/**:\n  ros__parameters:\n    ? [1, 2]\n    : 3\n", "line 3, column 7: a name must be plain text"),
        (b"- 1\n", "expected node names"),
    ],
)
def test_a_wrong_file_is_refused_with_its_place(tmp_path: Path, content: bytes, message: str) -> None:
    file = tmp_path / "params.yaml"
    file.write_bytes(content)
    with pytest.raises(ParameterFileError, match=message):
        read_file(file)


def test_a_value_with_an_alias_is_refused() -> None:
    with pytest.raises(ValueError, match="aliases are not supported"):
        parse_value("[&a 1, *a]")


def test_mappings_in_a_list_are_read_as_if_there_were_no_list(tmp_path: Path) -> None:
    file = tmp_path / "params.yaml"
    file.write_text("n:\n  ros__parameters:\n    a:\n      b:\n        - c:\n          - d\n        - e: {f: 1}\n")
    assert [(name, value) for _, name, value, _ in read_file(file)] == [("a.b.c", ["d"]), ("a.b.e.f", 1)]
