"""Files of RAPID: encodings, headers, folders and program files."""

from pathlib import Path

import pytest

from daidalos.common.errors import UserError
from daidalos.industry.rapid.inspection import inspect, read_signals
from daidalos.industry.rapid.parsing import parse
from daidalos.industry.rapid.sources import Source, find_programs, read_source

TEXT = 'MODULE m\n  ! Höhe\n  CONST string s := "für 5 µm";\nENDMODULE\n'


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "cp1252", "utf-16"])
def test_encodings(tmp_path: Path, encoding: str) -> None:
    path = tmp_path / "m.mod"
    path.write_bytes(TEXT.encode(encoding))
    source = read_source(path)
    assert source.text == TEXT
    assert source.text.encode(source.encoding) == path.read_bytes()
    assert parse(source).problems == []


def test_line_ends_of_windows(tmp_path: Path) -> None:
    path = tmp_path / "m.mod"
    path.write_bytes(TEXT.replace("\n", "\r\n").replace("CONST", "CNST").encode())
    (problem,) = parse(read_source(path)).problems[:1]
    assert (problem.line, problem.column) == (3, 3)


def test_a_binary_file_is_named(tmp_path: Path) -> None:
    path = tmp_path / "m.mod"
    path.write_bytes(b"MODULE\0\0")
    with pytest.raises(UserError, match=r"m\.mod: is not a text file"):
        read_source(path)


def test_places() -> None:
    source = Source("m.mod", "ab\r\ncd\n\nef")
    assert [source.place(offset) for offset in (0, 1, 4, 7, 8, 9)] == [(1, 1), (1, 2), (2, 1), (3, 1), (4, 1), (4, 2)]
    assert all(source.offset(*source.place(offset)) == offset for offset in range(len(source.text)) if offset != 3)


def _write(folder: Path, name: str, text: str) -> Path:
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return path


def test_a_program_file_names_its_modules(tmp_path: Path) -> None:
    _write(tmp_path, "Main.mod", "MODULE Main\nPROC main()\nhelp;\nENDPROC\nENDMODULE\n")
    _write(tmp_path, "Other.sys", "MODULE Other(SYSMODULE)\nPROC help()\nENDPROC\nENDMODULE\n")
    xml = '<?xml version="1.0" encoding="ISO-8859-1" ?>\n<Program>\n{}</Program>\n'
    modules = "".join(f"  <Module>{name}</Module>\n" for name in ("main.mod", "Other.sys"))
    program = _write(tmp_path, "p.pgf", xml.format(modules))
    assert [report.errors for report in inspect(program)] == [[], []]
    missing = _write(tmp_path, "q.pgf", xml.format("<Module>Gone.mod</Module>"))
    (report,) = inspect(missing)
    assert report.file.endswith("Gone.mod")
    assert report.errors[0].message == "No such file or directory"
    with pytest.raises(UserError, match="a program file is <Program>"):
        inspect(_write(tmp_path, "r.pgf", "<Other/>"))


def test_folders_are_tasks(tmp_path: Path) -> None:
    main = "MODULE {0}\nPROC main()\nENDPROC\nENDMODULE\n"
    _write(tmp_path, "RAPID/TASK1/PROGMOD/A.mod", main.format("A"))
    _write(tmp_path, "RAPID/TASK1/SYSMOD/B.sys", main.format("B"))
    _write(tmp_path, "RAPID/TASK2/PROGMOD/C.mod", main.format("C"))
    _write(tmp_path, "notes.txt", "no module")
    assert [len(program.files) for program in find_programs(tmp_path)] == [2, 1]
    assert [len(report.errors) for report in inspect(tmp_path)] == [0, 1, 0]


def test_beside_an_encrypted_module_unknown_names_are_warnings(tmp_path: Path) -> None:
    _write(tmp_path, "Main.mod", "MODULE Main\nPROC main()\nhelp;\nENDPROC\nENDMODULE\n")
    (tmp_path / "Secret.sys").write_bytes(b"MODULE Secret\0\x01\x02")
    main, secret = inspect(tmp_path)
    assert main.errors == []
    assert main.warnings[0].message == "procedure 'help' is not declared in the modules that can be read"
    assert secret.errors[0].message.startswith("is not a text file, or is encrypted")


def test_there_is_nothing_to_check(tmp_path: Path) -> None:
    with pytest.raises(UserError, match="no module in it"):
        inspect(tmp_path)
    with pytest.raises(UserError, match="No such file"):
        inspect(tmp_path / "gone.mod")


def test_signals_of_a_configuration(tmp_path: Path) -> None:
    text = 'EIO:CFG_1.0:6:1::\n#\nEIO_SIGNAL:\n\n      -Name "doGrip" -SignalType "DO" -Device "b1"\\\n'
    text += '      -DeviceMap "0"\n'
    text += '      -Name "diPart"\\\n      -SignalType "DI"\n#\nEIO_DEVICE:\n      -Name "b1" -Network "x"\n'
    assert read_signals(_write(tmp_path, "EIO.cfg", text)) == ["doGrip", "diPart"]
    with pytest.raises(UserError, match="no signal in it"):
        read_signals(_write(tmp_path, "empty.cfg", "#"))
