"""What launch files in markup share: substitutions in texts, registers, parsers."""

import contextlib
import io
import warnings
from types import SimpleNamespace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from launch import Action, LaunchContext, Substitution
from launch.actions import LogInfo
from launch.frontend import (
    Entity,
    InvalidFrontendLaunchFileError,
    Parser,
    expose_action,
    expose_substitution,
)
from launch.frontend import expose as expose_module
from launch.frontend import parser as parser_module
from launch.frontend.expose import instantiate_action, instantiate_substitution
from launch.frontend.parse_substitution import (
    parse_if_substitutions,
    parse_substitution,
    replace_escaped_characters,
)
from launch.frontend.type_utils import check_is_list_entity, get_data_type_from_identifier
from launch.substitutions import EnvironmentVariable, LaunchConfiguration
from launch.utilities.type_utils import extract_type


class Quoted(Substitution):
    """Its arguments, each in angle brackets."""

    def __init__(self, parts):
        self.parts = parts

    def perform(self, context):
        return "".join(f"<{''.join(sub.perform(context) for sub in part)}>" for part in self.parts)


@pytest.fixture(autouse=True)
def quoted(monkeypatch):
    """Expose `$(q ...)` for a while."""
    Parser.load_launch_extensions()
    # Those of launch are registered when their modules are loaded: not into the copy, which is thrown away.
    for register, package in (("substitution_parse_methods", "substitutions"), ("action_parse_methods", "actions")):
        expose_module._look_up("", getattr(expose_module, register), f"launch.{package}")
        monkeypatch.setattr(expose_module, register, dict(getattr(expose_module, register)))
    expose_substitution("q")(lambda data: (Quoted, {"parts": data}))


def perform(text):
    context = LaunchContext()
    context.launch_configurations.update(x="X", y="Y")
    return [substitution.perform(context) for substitution in parse_substitution(text)]


@pytest.mark.parametrize(
    ("text", "performed"),
    [
        ("", [""]),
        ("plain", ["plain"]),
        ("10e4", ["10e4"]),
        ("'quotes' are \"plain\"", ["'quotes' are \"plain\""]),
        ("a $ b $$ (c) )", ["a $ b $$ (c) )"]),
        ("$(q)", [""]),
        ("$(q a)", ["<a>"]),
        ("$( q   a\n b )", ["<a><b>"]),
        ("pre_$(q a)_mid_$(q b)", ["pre_", "<a>", "_mid_", "<b>"]),
        ("'$(q a)'", ["'", "<a>", "'"]),
        ("$(q 'a b' \"c d\")", ["<a b><c d>"]),
        ("$(q a'b c'd)", ["<ab cd>"]),
        ("$(q '')", ["<>"]),
        ("$(q 'it\"s' \"it's\")", ["<it\"s><it's>"]),
        ("$(q $(var x))", ["<X>"]),
        ("$(q a$(var x)b$(var y))", ["<aXbY>"]),
        ('$(q "a $(var x)" \'$(q "b c") d\')', ['<a X><<"b><c"> d>']),
        ('$(q "out $(q "in side")")', ["<out <in side>>"]),
        (r"\$(q a)", ["$(q a)"]),
        (r"$(q what/\$\(test asd\\\)) what", [r"<what/$(test><asd\)>", " what"]),
        (r"$(q a\ b)", ["<a b>"]),
        (r"$(q \"a b\")", ['<"a><b">']),
        (r"""$(q "\"a\" b")""", ['<"a" b>']),
        ("$(q f(a, g(b)) c)", ["<f(a, g(b))><c>"]),
        ("$(q ceil(1.3))", ["<ceil(1.3)>"]),
        ("$(var $(q a) $(var y))", ["Y"]),
        ("x\ny$(var x)", ["x\ny", "X"]),
    ],
)
def test_texts(text, performed):
    assert perform(text) == performed


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("$(q", "the '\\)' that ends '\\$\\(q' is missing"),
        ("a $(q 'b)", "closing ' is missing"),
        ('$(q "b)', 'closing " is missing'),
        ("$()", "name of a substitution is missing"),
        ("$(1)", "name of a substitution is missing"),
        ("$(q$)", "cannot follow"),
        ("$(q (a)", "is missing"),
    ],
)
def test_malformed_texts(text, reason):
    with pytest.raises(ValueError, match=reason):
        parse_substitution(text)


def test_unknown_substitution():
    with pytest.raises(RuntimeError, match=r"Unknown substitution: vaar; did you mean 'var'\?"):
        parse_substitution("$(vaar x)")


def escape(text):
    return "".join(
        "\\" + character if character in "\\$()'\" \t\n\r\x0b\x0c" or character.isspace() else character
        for character in text
    )


@given(st.text())
def test_escaped_text_is_itself(text):
    assert replace_escaped_characters(escape(text)) == text
    assert "".join(part.text for part in parse_substitution(escape(text))) == text


@given(st.lists(st.text(min_size=1), min_size=1))
def test_escaped_arguments_are_themselves(arguments):
    text = f"$(q {' '.join(map(escape, arguments))})"
    assert perform(text) == ["".join(f"<{argument}>" for argument in arguments)]


@given(st.lists(st.one_of(st.just("$(q a 'b c')"), st.text(alphabet="abc' \"()"))))
def test_pieces_in_a_row(pieces):
    expected = "".join("<a><b c>" if piece.startswith("$") else piece for piece in pieces)
    assert "".join(perform("".join(pieces))) == expected


@given(st.text(alphabet="$(q)\\'\" x"))
def test_any_text_is_parsed_or_refused(text):
    with contextlib.suppress(ValueError, RuntimeError, TypeError):
        assert parse_substitution(text)


def test_if_substitutions():
    assert parse_if_substitutions(1) == 1
    assert parse_if_substitutions(2.5) == 2.5
    assert parse_if_substitutions([1, 2]) == [1, 2]
    [sub] = parse_if_substitutions("$(var x)")
    assert isinstance(sub, LaunchConfiguration)
    mixed = parse_if_substitutions(["$(var x)", 1])
    assert isinstance(mixed[0][0], LaunchConfiguration)
    assert mixed[1] == 1
    assert parse_if_substitutions("plain") == "plain"
    texts = parse_if_substitutions(["a", "$(env b)"])
    assert texts[0] == "a"
    assert isinstance(texts[1][0], EnvironmentVariable)
    with pytest.raises(ValueError, match="one type"):
        parse_if_substitutions(["a", 1, 1.0])


BUILT_IN = {
    "$(var x)": "X",
    "$(var none default)": "default",
    "$(env LT_X)": "env",
    "$(env LT_NONE 'a b')": "a b",
    "$(eval '1 + 1')": "2",
    "$(eval \"'asd' + 'bsd'\")": "asdbsd",
    "$(eval '$(var two) * 2.')": "4.0",
    "$(eval 'math.ceil(1.3)')": "2",
    "$(eval 'sys.byteorder in (\"little\", \"big\")' 'sys, math')": "True",
    "$(not true)": "false",
    "$(and true $(not false))": "true",
    "$(or false false)": "false",
    "$(any false true)": "true",
    "$(all true true false)": "false",
    "$(equals 1 1.0)": "true",
    "$(not-equals a a)": "false",
    "$(if true a b)": "a",
    "$(if false a b)": "b",
    "$(path-join a 'b c' d$(var x))": "a/b c/dX",
    "$(string-join . a b)": "a.b",
    "$(command 'echo hello')": "hello\n",
    "$(command 'sh -c \"echo a; echo b >&2\"' ignore)": "a\n",
    "$(dirname)": "/dir",
    "$(filename)": "/dir/file",
}


@pytest.mark.parametrize(("text", "performed"), BUILT_IN.items())
def test_built_in_substitutions(text, performed, monkeypatch):
    monkeypatch.setenv("LT_X", "env")
    context = LaunchContext()
    context.launch_configurations.update(x="X", two="2")
    context.extend_locals({"current_launch_file_path": "/dir/file", "current_launch_file_directory": "/dir"})
    [substitution] = parse_substitution(text)
    assert substitution.perform(context) == performed


@pytest.mark.parametrize(
    "text",
    [
        "$(var)",
        "$(env)",
        "$(env a b c)",
        "$(eval)",
        "$(not)",
        "$(and a)",
        "$(if a)",
        "$(dirname x)",
        "$(command)",
        "$(string-join)",
        "$(anon)",
        "$(find-exec)",
        "$(file-content a b)",
        "$(index)",
        "$(for-var)",
        "$(equals a)",
    ],
)
def test_wrong_numbers_of_arguments(text):
    with pytest.raises(TypeError, match="argument"):
        parse_substitution(text)


# Registers --------------------------------------------------------------------------------------------


def test_exposing():
    register = {}
    expose = getattr(expose_module, "__expose_impl")

    class Thing:
        @classmethod
        def parse(cls, entity, parser):
            return cls, {}

    def function(entity, parser):
        return Thing, {}

    assert expose("thing", register, "action")(Thing) is Thing
    assert register["thing"] == Thing.parse
    assert expose("function", register, "action")(function) is function
    expose("function", register, "action")(function)
    with pytest.raises(RuntimeError, match="two actions are exposed as 'function'"):
        expose("function", register, "action")(lambda entity, parser: None)
    with pytest.raises(RuntimeError, match="without a method 'parse'"):
        expose("other", register, "action")(type("Other", (), {}))
    with pytest.raises(RuntimeError, match="is not a callable or a class containing a parse method: 5"):
        expose("other", register, "action")(5)


class FakeEntity(Entity):
    def __init__(self, type_name, **attributes):
        self.__type_name = type_name
        self.__attributes = attributes

    @property
    def type_name(self):
        return self.__type_name

    @property
    def children(self):
        return []

    def get_attr(self, name, *, data_type=str, optional=False, can_be_str=True):
        return self.__attributes.get(name)

    def assert_entity_completely_parsed(self):
        pass


def test_actions_of_extensions():
    @expose_action("shout")
    class Shout(Action):
        def __init__(self, text, **kwargs):
            super().__init__(**kwargs)
            self.text = text

        @classmethod
        def parse(cls, entity, parser):
            _, kwargs = super().parse(entity, parser)
            return cls, {**kwargs, "text": entity.get_attr("text")}

    action = Parser().parse_action(FakeEntity("shout", text="hey", **{"if": "true"}))
    assert action.text == "hey"
    assert action.condition.evaluate(LaunchContext())
    assert isinstance(instantiate_action(FakeEntity("log", message="x"), Parser()), LogInfo)
    with pytest.raises(RuntimeError, match="Unrecognized entity of the type: whisper"):
        instantiate_action(FakeEntity("whisper"), Parser())


def test_substitutions_with_positional_arguments():
    expose_substitution("pos")(lambda data: (Quoted, [data], {}))
    assert instantiate_substitution("pos", ["a"]).parts == ["a"]
    assert instantiate_substitution("pos").parts == []


def test_base_entity():
    entity = Entity()
    for attribute in ("type_name", "parent", "children"):
        with pytest.raises(NotImplementedError):
            getattr(entity, attribute)
    with pytest.raises(NotImplementedError):
        entity.get_attr("x")
    with pytest.raises(NotImplementedError):
        entity.assert_entity_completely_parsed()
    assert entity.location == (None, None)


def test_types():
    assert check_is_list_entity(list[Entity])
    assert not check_is_list_entity(list[int])
    assert get_data_type_from_identifier("int") is int
    assert extract_type(get_data_type_from_identifier("list_of_bool")) == (bool, True)
    with pytest.raises(ValueError, match="unknown type 'dict'"):
        get_data_type_from_identifier("dict")


# Parsers ----------------------------------------------------------------------------------------------


def test_what_can_be_read():
    assert {"launch.xml", "launch.yaml"} <= set(Parser.get_available_extensions())
    assert Parser.is_extension_valid("launch.xml")
    assert not Parser.is_extension_valid("docx")
    assert Parser.is_filename_valid("a.launch.yml")
    assert not Parser.is_filename_valid("a.launch.py")
    assert Parser.get_parsers_from_filename("a.launch.xml")[0].__module__ == "launch_xml.parser"
    assert Parser.get_parser_from_extension("launch.yaml").__module__ == "launch_yaml.parser"
    assert Parser.get_file_extensions() == set()
    assert not Parser.may_parse("a.xml")
    with pytest.raises(RuntimeError, match="docx"):
        Parser.get_parser_from_extension("docx")


@pytest.mark.parametrize("text", ["<launch><log message='x'/></launch>", "launch:\n- log: {message: x}\n"])
def test_files_without_names(text):
    root, parser = Parser.load(io.StringIO(text))
    assert isinstance(parser.parse_description(root).entities[0], LogInfo)


def test_files_that_nobody_can_read(tmp_path):
    with pytest.raises(InvalidFrontendLaunchFileError, match="multiple exceptions"):
        Parser.load(io.StringIO("neither [ this < nor that"))
    path = tmp_path / "a.launch.xml"
    path.write_text("launch: []")
    with pytest.raises(InvalidFrontendLaunchFileError, match=r"a\.launch\.xml:1: malformed XML"):
        Parser.load(str(path))


class BrokenEntryPoint:
    name = "broken"

    def load(self):
        raise ValueError("I do not want to be loaded")


class Found(SimpleNamespace):
    """Entry points as `importlib.metadata` gives them."""

    def select(self, group):
        return self.found if group == self.group else []


def test_broken_extensions_are_left_out(monkeypatch):
    for attribute, group, load in (
        ("extensions_loaded", "launch.frontend.launch_extension", Parser.load_launch_extensions),
        ("frontend_parsers", "launch.frontend.parser", Parser.load_parser_implementations),
    ):
        monkeypatch.setattr(Parser, attribute, False if attribute == "extensions_loaded" else None)
        found = Found(found=[BrokenEntryPoint()], group=group)
        monkeypatch.setattr(parser_module.importlib_metadata, "entry_points", lambda found=found: found)
        with pytest.warns(UserWarning, match="Failed to load the (parser|launch extension) 'broken'"):
            load()
    assert Parser.is_extension_valid("launch.xml")


def test_extensions_are_found_by_their_entry_points(monkeypatch):
    class MarkdownParser(Parser):
        @classmethod
        def get_file_extensions(cls):
            return {"md"}

    entry_point = SimpleNamespace(name="md", load=lambda: MarkdownParser)
    monkeypatch.setattr(Parser, "frontend_parsers", None)
    found = Found(found=[entry_point], group="launch.frontend.parser")
    monkeypatch.setattr(parser_module.importlib_metadata, "entry_points", lambda: found)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert Parser.get_parser_from_extension("md") is MarkdownParser
