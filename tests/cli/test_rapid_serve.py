"""`daidalos rapid serve`: what keeps it from serving is one line."""

import socket

import pytest

from daidalos.cli.daidalos import main

PROGRAM = "MODULE m\n  PROC main()\n    WaitTime 1;\n  ENDPROC\nENDMODULE\n"


@pytest.fixture
def program(tmp_path):
    path = tmp_path / "m.mod"
    path.write_text(PROGRAM)
    return str(path)


def test_a_port_that_is_taken(program, capsys):
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        port = other.getsockname()[1]
        assert main(["rapid", "serve", program, "--port", str(port)]) != 0
    assert capsys.readouterr().err.startswith(f"daidalos rapid: 127.0.0.1:{port} cannot be listened on: ")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--robot", "irb12"], "there is no arm 'irb12'"),
        (["--rws", "2", "--certificate", "none.pem"], "--certificate and --key go together"),
        (["--rws", "2", "--certificate", "none.pem", "--key", "none.pem"], "none.pem: cannot be used with none.pem"),
        (["--port", "99999"], "99999 cannot be listened on"),
    ],
)
def test_what_is_wrong_is_one_line(program, arguments, message, capsys):
    assert main(["rapid", "serve", program, *arguments]) != 0
    error = capsys.readouterr().err
    assert message in error
    assert len(error.splitlines()) == 1
