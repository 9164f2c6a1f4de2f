"""Language server of RAPID: what `workspace` and `completion` know, in the words of the Language Server Protocol."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlsplit
from urllib.request import url2pathname

from daidalos import __version__
from daidalos.common.errors import UserError
from daidalos.industry.rapid import tree
from daidalos.industry.rapid.editing.completion import Completion, complete
from daidalos.industry.rapid.editing.workspace import Program, Workspace
from daidalos.industry.rapid.formatting import format_source
from daidalos.industry.rapid.problems import Problem
from daidalos.industry.rapid.sources import Source

NAME = "daidalos rapid"


def serve() -> None:
    """Serve one editor on standard input and output, until it ends.

    Raises
    ------
    UserError
        If pygls is not installed.
    """
    make_server().start_io()


def make_server() -> Any:
    """Return a server of pygls with all features.

    Raises
    ------
    UserError
        If pygls is not installed.
    """
    try:
        from lsprotocol import types
        from pygls.lsp.server import LanguageServer
    except ImportError:
        raise UserError("the language server needs pygls; run: pip install 'daidalos[industry]'") from None
    server = LanguageServer(NAME, __version__)
    handlers = Handlers(server, types)
    features = {
        types.TEXT_DOCUMENT_DID_OPEN: handlers.opened,
        types.TEXT_DOCUMENT_DID_CHANGE: handlers.changed,
        types.TEXT_DOCUMENT_DID_CLOSE: handlers.closed,
        types.TEXT_DOCUMENT_HOVER: handlers.hover,
        types.TEXT_DOCUMENT_DEFINITION: handlers.definition,
        types.TEXT_DOCUMENT_REFERENCES: handlers.references,
        types.TEXT_DOCUMENT_DOCUMENT_SYMBOL: handlers.outline,
        types.TEXT_DOCUMENT_FORMATTING: handlers.format,
        types.TEXT_DOCUMENT_RENAME: handlers.rename,
    }
    for name, method in features.items():
        server.feature(name)(_function(method))
    options = types.CompletionOptions(trigger_characters=[".", "\\"])
    server.feature(types.TEXT_DOCUMENT_COMPLETION, options)(_function(handlers.complete))
    return server


def _function(method: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """Return a method as a function, which pygls can write its notes on."""

    def handle(params: Any) -> Any:
        return method(params)

    return handle


class Handlers:
    """What the server does for each request.

    Parameters
    ----------
    server
        Server of pygls.
    types
        The module `lsprotocol.types`.
    """

    def __init__(self, server: Any, types: Any) -> None:
        self._server = server
        self._types = types
        self._workspace = Workspace()
        self._uris: dict[str, str] = {}

    # Documents

    def opened(self, params: Any) -> None:
        """Take a module that the editor has opened."""
        self._update(params.text_document.uri)

    changed = opened

    def closed(self, params: Any) -> None:
        """Take a module from disk again."""
        uri = params.text_document.uri
        self._workspace.close(_path(uri))
        self._publish(uri, [], None)

    def _update(self, uri: str) -> None:
        file = _path(uri)
        self._uris[file] = uri
        self._workspace.update(file, self._server.workspace.get_text_document(uri).source)
        program = self._workspace.program(file)
        problems = program.problems()
        for other in self._workspace.open_files():
            if other in problems:
                self._publish(self._uris[other], problems[other], program.modules[other].source)

    def _publish(self, uri: str, problems: list[Problem], source: Source | None) -> None:
        types = self._types
        severity = types.DiagnosticSeverity
        diagnostics = [
            types.Diagnostic(
                range=self._range(source, *_span(source, one)),
                message=one.message,
                severity=severity.Warning if one.is_warning else severity.Error,
                source=NAME,
                code=one.kind,
            )
            for one in problems
            if source is not None
        ]
        self._server.text_document_publish_diagnostics(types.PublishDiagnosticsParams(uri=uri, diagnostics=diagnostics))

    # Questions

    def hover(self, params: Any) -> Any:
        """Return the declaration of a name."""
        program, file, offset = self._locate(params)
        text = program.hover(file, offset)
        if text is None:
            return None
        types = self._types
        return types.Hover(types.MarkupContent(types.MarkupKind.Markdown, f"```rapid\n{text}\n```"))

    def definition(self, params: Any) -> Any:
        """Return where a name is declared."""
        program, file, offset = self._locate(params)
        target = program.definition(file, offset)
        if target is None:
            return None
        return self._location(program, target.file, target.start, target.start + len(target.text))

    def references(self, params: Any) -> Any:
        """Return where a name is used."""
        program, file, offset = self._locate(params)
        target = program.definition(file, offset)
        found = sorted(set(program.uses(target))) if target is not None else []
        return [self._location(program, *one) for one in found]

    def complete(self, params: Any) -> Any:
        """Return what can be written at a place."""
        program, file, offset = self._locate(params)
        types = self._types
        kinds = {
            "keyword": types.CompletionItemKind.Keyword,
            "type": types.CompletionItemKind.Class,
            "data": types.CompletionItemKind.Variable,
            "routine": types.CompletionItemKind.Function,
            "component": types.CompletionItemKind.Field,
            "parameter": types.CompletionItemKind.Property,
        }

        def item(one: Completion) -> Any:
            return types.CompletionItem(label=one.text, kind=kinds[one.kind], detail=one.detail)

        return types.CompletionList(is_incomplete=False, items=[item(one) for one in complete(program, file, offset)])

    def outline(self, params: Any) -> Any:
        """Return modules, and what is declared in them."""
        file = _path(params.text_document.uri)
        parsed = self._workspace.program(file).modules[file]
        return [self._symbol(parsed.source, module) for module in parsed.tree.modules]

    def format(self, params: Any) -> Any:
        """Return the formatted module; where it has errors, it stays as it is."""
        file = _path(params.text_document.uri)
        source = self._workspace.program(file).modules[file].source
        try:
            text = format_source(source)
        except UserError:
            return None
        return [self._types.TextEdit(self._range(source, 0, len(source.text)), text)]

    def rename(self, params: Any) -> Any:
        """Return the changes that give a name another spelling everywhere."""
        program, file, offset = self._locate(params)
        try:
            places = program.rename(file, offset, params.new_name)
        except UserError as error:
            from pygls.exceptions import JsonRpcInvalidParams

            raise JsonRpcInvalidParams(str(error)) from None
        edits = {
            self._uri(where): [
                self._types.TextEdit(self._range(program.modules[where].source, *one), params.new_name) for one in spans
            ]
            for where, spans in places.items()
        }
        return self._types.WorkspaceEdit(changes=edits)

    # Places

    def _locate(self, params: Any) -> tuple[Program, str, int]:
        file = _path(params.text_document.uri)
        program = self._workspace.program(file)
        source = program.modules[file].source
        start = source.offset(params.position.line + 1, 1)
        line = source.text[start : source.offset(params.position.line + 2, 1)] or source.text[start:]
        return program, file, start + _characters(line, params.position.character)

    def _location(self, program: Program, file: str, start: int, end: int) -> Any:
        return self._types.Location(self._uri(file), self._range(program.modules[file].source, start, end))

    def _uri(self, file: str) -> str:
        return self._uris.get(file) or Path(file).absolute().as_uri()

    def _range(self, source: Source | None, start: int, end: int) -> Any:
        assert source is not None
        return self._types.Range(self._position(source, start), self._position(source, end))

    def _position(self, source: Source, offset: int) -> Any:
        line, column = source.place(offset)
        return self._types.Position(line - 1, _units(source.text[offset - column + 1 : offset]))

    def _symbol(self, source: Source, node: Any) -> Any:
        types = self._types
        kinds = types.SymbolKind
        name = node.name
        children = list(self._children(source, node))
        kind = {
            tree.Module: kinds.Module,
            tree.Record: kinds.Struct,
            tree.Alias: kinds.Class,
            tree.Routine: kinds.Function,
        }.get(type(node), kinds.Constant if getattr(node, "kind", "") == "CONST" else kinds.Variable)
        return types.DocumentSymbol(
            name=name.text or "?",
            kind=kind,
            range=self._range(source, node.start, max(node.end, name.end)),
            selection_range=self._range(source, name.start, name.end),
            detail=_detail(node),
            children=children,
        )

    def _children(self, source: Source, node: Any) -> Iterator[Any]:
        if isinstance(node, tree.Module):
            yield from (self._symbol(source, one) for one in node.items if not isinstance(one, tree.Placeholder))
        elif isinstance(node, tree.Routine):
            yield from (self._symbol(source, one) for one in node.body if isinstance(one, tree.Data))


def _detail(node: Any) -> str:
    if isinstance(node, tree.Data):
        return f"{node.kind} {node.type.text}"
    return node.kind if isinstance(node, tree.Routine) else ""


def _span(source: Source | None, problem: Problem) -> tuple[int, int]:
    assert source is not None
    start = source.offset(problem.line, problem.column)
    return start, max(source.offset(problem.line, problem.end_column or problem.column + 1), start)


def _path(uri: str) -> str:
    """Return the path of a document; one that has never been saved keeps its address."""
    parts = urlsplit(uri)
    return url2pathname(unquote(parts.path)) if parts.scheme == "file" else uri


def _units(text: str) -> int:
    """Return the length of a text in units of UTF-16, which the protocol counts in."""
    return len(text) if text.isascii() else len(text.encode("utf-16-le")) // 2


def _characters(line: str, units: int) -> int:
    """Return how many characters of a line a number of units of UTF-16 is."""
    if line.isascii():
        return min(units, len(line))
    return len(line.encode("utf-16-le")[: units * 2].decode("utf-16-le", "ignore"))
