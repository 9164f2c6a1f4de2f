"""The language server as an editor uses it: a process, and the protocol on its standard input and output."""

import asyncio
import sys
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("pygls")

from lsprotocol import types
from pygls.lsp.client import LanguageClient

TEXT = """MODULE m
  VAR num größe := 0; ! 𝛼
  PROC main()
    CONST string s := "𝛼"; größe := größe + 1;
    TPWrit "x";
  ENDPROC
ENDMODULE
"""
TIMEOUT_S = 20


def talk(steps: Callable[[LanguageClient, str, "asyncio.Queue[Any]"], Awaitable[None]], path: Path) -> None:
    """Start the server and open a module, then take steps with it."""

    async def session() -> None:
        client = LanguageClient("test", "1")
        diagnostics: asyncio.Queue[Any] = asyncio.Queue()
        client.feature(types.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS)(lambda params: diagnostics.put_nowait(params))
        await client.start_io(sys.executable, "-m", "daidalos.cli.daidalos", "rapid", "server")
        await client.initialize_async(types.InitializeParams(capabilities=types.ClientCapabilities()))
        client.initialized(types.InitializedParams())
        item = types.TextDocumentItem(uri=path.as_uri(), language_id="rapid", version=1, text=TEXT)
        client.text_document_did_open(types.DidOpenTextDocumentParams(item))
        await steps(client, path.as_uri(), diagnostics)
        await client.shutdown_async(None)
        client.exit(None)
        await client.stop()

    asyncio.run(asyncio.wait_for(session(), TIMEOUT_S))


def test_a_session(tmp_path: Path) -> None:
    path = tmp_path / "m.mod"
    path.write_text(TEXT)

    async def steps(client: LanguageClient, uri: str, diagnostics: "asyncio.Queue[Any]") -> None:
        document = types.TextDocumentIdentifier(uri)
        (found,) = (await diagnostics.get()).diagnostics
        assert found.message.startswith("procedure 'TPWrit' is not declared; did you mean 'TPWrite'")
        assert found.range == types.Range(types.Position(4, 4), types.Position(4, 10))

        column = TEXT.splitlines()[3].index("größe") + 1  # the letter before takes two units of UTF-16
        place = types.Position(3, column + 1)
        hover = await client.text_document_hover_async(types.HoverParams(document, place))
        assert "VAR num größe := 0;" in hover.contents.value
        definition = await client.text_document_definition_async(types.DefinitionParams(document, place))
        assert definition.range == types.Range(types.Position(1, 10), types.Position(1, 15))

        edit = await client.text_document_rename_async(types.RenameParams(document, place, "size"))
        assert [one.range.start for one in edit.changes[uri]] == [
            types.Position(1, 10),
            types.Position(3, column),
            types.Position(3, column + 9),
        ]
        (module,) = await client.text_document_document_symbol_async(types.DocumentSymbolParams(document))
        assert [one.name for one in module.children] == ["größe", "main"]
        completion = await client.text_document_completion_async(
            types.CompletionParams(document, types.Position(4, 10))
        )
        assert "TPWrite" in [one.label for one in completion.items]

        change = types.TextDocumentContentChangeWholeDocument(TEXT.replace("TPWrit ", "TPWrite "))
        version = types.VersionedTextDocumentIdentifier(2, uri)
        client.text_document_did_change(types.DidChangeTextDocumentParams(version, [change]))
        assert not (await diagnostics.get()).diagnostics

    talk(steps, path)


def test_without_pygls_there_is_one_line(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    from daidalos.cli.daidalos import main

    monkeypatch.setitem(sys.modules, "pygls.lsp.server", None)
    assert main(["rapid", "server"]) == 2
    assert "the language server needs pygls; run: pip install 'daidalos[industry]'" in capsys.readouterr().err
