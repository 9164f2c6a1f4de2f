"""The linters that packages call in their tests."""

import subprocess
import sys

import ament_copyright.main
import ament_flake8.main
import ament_pep257.main
import pytest

GOOD = '# Copyright 2024 Somebody\n# Licensed under the Apache License, Version 2.0\n"""A module."""\n\n\nx = 1\n'


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "good.py").write_text(GOOD)
    (tmp_path / "__init__.py").write_text("")
    return tmp_path


@pytest.mark.slow
def test_good_files_pass_all(folder):
    assert ament_flake8.main.main_with_errors(argv=[]) == (0, [])
    assert ament_pep257.main.main(argv=["."]) == 0
    assert ament_copyright.main.main(argv=["."]) == 0


def test_code_is_named_with_its_place(folder):
    (folder / "bad.py").write_text("import os\nx=1\n")
    status, errors = ament_flake8.main.main_with_errors(argv=["."])
    assert status == 1
    assert [error.split()[0] for error in errors] == ["bad.py:1:1:", "bad.py:2:2:"]


def test_lines_may_be_99_long(folder):
    (folder / "long.py").write_text(f"x = '{'a' * 93}'\n")
    assert ament_flake8.main.main(argv=["long.py"]) == 0
    assert ament_flake8.main.main(argv=["--linelength", "79", "long.py"]) == 1


def test_docstrings_are_named_with_their_place(folder, capsys):
    (folder / "bad.py").write_text('def f():\n    """returns nothing"""\n')
    assert ament_pep257.main.main(argv=["."]) == 1
    assert "bad.py:2 in public function `f`: D" in capsys.readouterr().out


def test_notices_of_copyright_and_licence_are_missed(folder, capsys):
    (folder / "none.py").write_text("x = 1\n")
    (folder / "half.py").write_text("# Copyright (c) 2024 Somebody\nx = 1\n")
    assert ament_copyright.main.main(argv=["."]) == 1
    assert capsys.readouterr().out.splitlines()[:2] == [
        "half.py: could not find license",
        "none.py: could not find copyright notice",
    ]


def test_folders_may_be_ignored(folder):
    (folder / "generated").mkdir()
    (folder / "generated" / "AMENT_IGNORE").write_text("")
    (folder / "generated" / "bad.py").write_text("x=1\n")
    assert ament_flake8.main.main(argv=[]) == 0


def test_without_the_linter_a_test_is_skipped_and_a_command_says_how_to_get_it(folder, monkeypatch):
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    with pytest.raises(pytest.skip.Exception, match="not installed"):
        ament_flake8.main.main(argv=[])
    monkeypatch.delenv("PYTEST_CURRENT_TEST")
    with pytest.raises(SystemExit, match=r'pip install "daidalos\[lint\]"'):
        ament_flake8.main.main(argv=[])


@pytest.mark.slow
def test_the_markers_are_known(folder):
    (folder / "test_it.py").write_text(
        "import pytest\n\n\n@pytest.mark.flake8\n@pytest.mark.linter\ndef test_it():\n    pass\n"
    )
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider"]
    done = subprocess.run([*command, "--strict-markers", "test_it.py"], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout
