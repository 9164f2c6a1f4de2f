"""The parser: every construct, its tree, and all syntax errors of a file at their places."""

import pytest

from daidalos.industry.rapid import tree

from .programs import EVERYTHING, module, parsed


def errors(text: str) -> list[tuple[int, int, str]]:
    return [(one.line, one.column, one.message) for one in parsed(text).problems]


def expression(text: str) -> str:
    """Return an expression with brackets around each operation."""
    main = parsed(module(f"x := {text};")).tree.modules[0].items[0]
    assert isinstance(main, tree.Routine)
    assignment = main.body[0]
    assert isinstance(assignment, tree.Assignment)
    return _bracketed(assignment.value)


def _bracketed(node: object) -> str:
    match node:
        case tree.Binary():
            return f"({_bracketed(node.left)} {node.operator} {_bracketed(node.right)})"
        case tree.Unary():
            return f"({node.operator} {_bracketed(node.operand)})"
        case tree.Variable():
            return node.name.text
        case tree.Component():
            return f"{_bracketed(node.of)}.{node.name.text}"
        case tree.Index():
            return f"{_bracketed(node.of)}{{{','.join(map(_bracketed, node.indices))}}}"
        case tree.Number():
            return node.text
    return type(node).__name__


def test_every_construct_is_read() -> None:
    found = parsed(EVERYTHING)
    assert found.problems == []
    (one,) = found.tree.modules
    assert one.name.text == "Everything"
    assert one.attributes == ["SYSMODULE", "NOSTEPIN"]
    routines = [item for item in one.items if isinstance(item, tree.Routine)]
    assert [(one.kind, one.name.text) for one in routines] == [
        ("PROC", "main"),
        ("PROC", "draw"),
        ("FUNC", "area"),
        ("PROC", "take"),
        ("TRAP", "onAlarm"),
    ]
    assert [handler.kind for handler in routines[0].handlers] == ["BACKWARD", "ERROR", "UNDO"]
    draw = routines[1]
    assert [[one.name.text for one in group.alternatives] for group in draw.groups] == [
        ["at"],
        ["Fast", "Slow"],
        ["times"],
        ["height"],
        ["Loud"],
    ]
    assert [one.dimensions for one in routines[3].parameters()] == [0, 1, 0]
    assert len(found.comments) == 1


def test_places_are_offsets_into_the_text() -> None:
    found = parsed(EVERYTHING)
    for node in tree.walk(found.tree):
        if isinstance(node, tree.Name):
            assert EVERYTHING[node.start : node.end] == node.text


@pytest.mark.parametrize(
    ("text", "grouped"),
    [
        ("a OR b AND c", "(a OR (b AND c))"),
        ("a AND b = c", "(a AND (b = c))"),
        ("a = b + c", "(a = (b + c))"),
        ("a + b * c - d", "((a + (b * c)) - d)"),
        ("a * b DIV c MOD d / e", "((((a * b) DIV c) MOD d) / e)"),
        ("a OR b XOR c", "((a OR b) XOR c)"),
        ("NOT a AND b", "((NOT a) AND b)"),
        ("NOT a = b", "(NOT (a = b))"),
        ("a <> NOT b", "(a <> (NOT b))"),
        ("-a * b", "((- a) * b)"),
        ("a - -b", "(a - (- b))"),
        ("(a + b) * c", "((a + b) * c)"),
        ("a.b{1,c}.d", "a.b{1,c}.d"),
        ("a<b", "(a < b)"),
    ],
)
def test_operators_bind_by_their_priority(text: str, grouped: str) -> None:
    assert expression(text) == grouped


@pytest.mark.parametrize("text", ["1", "1.5", ".5", "5.", "1E9", "9E+09", "1.5e-3", "0x1F", "0b101", "0o17"])
def test_numbers(text: str) -> None:
    assert parsed(module(f"x := {text};")).problems == []


def test_upper_and_lower_case_are_the_same() -> None:
    assert parsed("module M\nproc Main()\nif TRUE then\nreturn;\nendif\nendproc\nendmodule").problems == []


def test_lines_without_a_module_are_a_fragment() -> None:
    found = parsed("MoveL p10, v1000, fine, tool0;\nWaitTime 1;\n")
    assert found.problems == []
    assert [type(one).__name__ for one in found.tree.fragment] == ["CallStatement", "CallStatement"]


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("x = 5;", "'=' compares; ':=' assigns a value"),
        ("IF x := 5 THEN ENDIF", "':=' assigns; '=' compares two values"),
        ('TPWrite "a;', "this string has no closing '\"' on its line"),
        ("x := (1 + 2;", "')' is missing before ';'"),
        ("WHILE TRUE x := 1; ENDWHILE", "DO is missing before 'x'"),
        ("x := 1 +;", "';' is not expected here; expected an expression"),
        ("x := #;", "'#' is not a name, a number or a symbol of RAPID"),
        ("ENDIF", "ENDIF without IF before it"),
        ("VAR num FOR;", "';' is not expected here; expected a name"),
    ],
)
def test_an_error_says_what_is_wrong(line: str, message: str) -> None:
    assert message in [text for _, _, text in errors(module(line))]


def test_a_missing_semicolon_is_named_where_it_belongs() -> None:
    assert errors(module("x := 5\ny := 6;")) == [(4, 7, "';' is missing before 'y'")]


def test_a_keyword_cannot_be_a_name() -> None:
    assert errors(module("", "VAR num step := 1;")) == [(2, 9, "'step' is a keyword of RAPID and cannot be a name")]


def test_blocks_without_an_end_name_their_beginning() -> None:
    text = "MODULE m\nPROC main()\nIF TRUE THEN\nWHILE TRUE DO\nENDPROC\n"
    assert [(line, message) for line, _, message in errors(text)] == [
        (5, "ENDWHILE is missing; its WHILE is in line 4"),
        (5, "ENDIF is missing; its IF is in line 3"),
        (6, "ENDMODULE is missing; its MODULE is in line 1"),
    ]


def test_a_routine_outside_of_a_module() -> None:
    assert errors("PROC main()\nENDPROC\n")[0] == (
        1,
        1,
        "'PROC' stands in no module; 'MODULE name' is missing before it",
    )


def test_all_errors_of_a_file_are_found_at_once() -> None:
    lines = ["x = 5;", "y := 6;", "z := (7;", "IF x 3 THEN", "y := 1;", "ENDIF", "w := ;", "GOTO;"]
    assert {line for line, _, _ in errors(module("\n".join(lines)))} == {4, 6, 7, 10, 11}


def test_what_follows_an_error_is_read() -> None:
    text = "MODULE m\nPROC a()\nx := 1 + * 2 foo;\nENDPROC\nPROC b()\ny := 2;\nENDPROC\nENDMODULE"
    (one,) = parsed(text).tree.modules
    assert [item.name.text for item in one.items if isinstance(item, tree.Routine)] == ["a", "b"]


@pytest.mark.parametrize("text", ["", "  \n! only a comment\n"])
def test_an_empty_file_has_no_module(text: str) -> None:
    assert errors(text) == [(1, 1, "there is no module in this file; it begins with MODULE name")]


def test_deep_nesting_ends_with_an_error() -> None:
    found = errors(module("x := " + "(" * 5000 + "1" + ")" * 5000 + ";"))
    assert [message for _, _, message in found] == ["this is nested too deeply"]
