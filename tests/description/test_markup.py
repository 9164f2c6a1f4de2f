import contextlib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.description.errors import DescriptionError
from daidalos.description.markup import Element, parse_markup

names = st.from_regex(r"[a-z][a-z_]{0,8}", fullmatch=True)
words = st.text(st.characters(codec="utf-8", exclude_categories=["Cc", "Cs", "Cn"]), max_size=20)


@st.composite
def elements(draw, depth=3):
    children = draw(st.lists(elements(depth=depth - 1), max_size=3)) if depth else []
    text = "" if children else draw(words).strip()
    return Element(draw(names), draw(st.dictionaries(names, words, max_size=3)), text, children)


def as_tuple(element):
    return element.tag, element.attributes, element.text.strip(), [as_tuple(child) for child in element]


@given(elements())
def test_what_is_written_reads_the_same(element):
    read = parse_markup(element.to_text())
    assert as_tuple(read) == as_tuple(element)


def test_lines_are_kept():
    root = parse_markup("\n\n<?xml version='1.0'?>\n<robot>\n  <link\n    name='a'/>\n</robot>", "r.urdf")
    assert (root.line, root.children[0].line) == (4, 5)
    assert root.children[0].where == "r.urdf:5"


def test_comments_may_come_before_the_declaration():
    root = parse_markup("<!-- by\n ?> me --> <!-- -->\n<?xml version='1.0'?>\n<a>\n<b/></a>", "a.sdf")
    assert (root.line, root.children[0].line) == (4, 5)
    assert parse_markup("<?xml verison='1.0'?>\n<a/>").line == 2


def test_zeros_at_the_end_do_not_count():
    assert parse_markup(b"<a/>\r\n\0").tag == "a"
    assert parse_markup("<?xml version='1.0' encoding='utf-16'?><a/>".encode("utf-16")).tag == "a"


def test_byte_order_mark_and_declared_encoding():
    assert parse_markup(b"\xef\xbb\xbf<a/>").tag == "a"
    assert parse_markup('<?xml version="1.0" encoding="latin-1"?><a b="ü"/>').attribute("b") == "ü"
    assert parse_markup('<?xml version="1.0" encoding="latin-1"?><a b="ü"/>'.encode("latin-1")).attribute("b") == "ü"


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("", 0, "empty"),
        ("  \n ", 0, "empty"),
        ("<a>\n<b></a>", 2, "mismatched tag"),
        ("<a/>\n<b/>", 2, "junk after document element"),
        ("hello", 1, "syntax error"),
    ],
)
def test_malformed_documents_name_the_line(text, line, words):
    with pytest.raises(DescriptionError, match=words) as caught:
        parse_markup(text, "x.urdf")
    assert (caught.value.source, caught.value.line) == ("x.urdf", line)


@pytest.mark.parametrize(
    ("text", "equal"),
    [
        ("<a><!-- x -- y --->\n<b/></a>", "<a>\n<b/></a>"),
        ("<a>\n<b c=3 d='4' e=f/></a>", "<a>\n<b c='3' d='4' e='f'/></a>"),
        ("<a b='1' b='2'>\n<c/></a>", "<a b='1'>\n<c/></a>"),
        ("<a b='x<y & z'>\np & q<c/></a>", "<a b='x&lt;y &amp; z'>\np &amp; q<c/></a>"),
        (b"<a b='\xfc'>\n<c/></a>", "<a b='\u00fc'>\n<c/></a>"),
        ("<a\n b=1\n>\n<![CDATA[<x y=1>]]><c d=2/></a>", "<a\n b='1'\n>\n&lt;x y=1&gt;<c d='2'/></a>"),
    ],
)
def test_what_tinyxml_tolerates_is_read(text, equal):
    found, expected = parse_markup(text), parse_markup(equal)
    assert as_tuple(found) == as_tuple(expected)
    assert [one.line for one in found.walk()] == [one.line for one in expected.walk()]


@given(st.text(alphabet="<>ab='\"/!-& \n[]?", max_size=40))
def test_any_text_is_a_tree_or_a_descriptions_error(text):
    with contextlib.suppress(DescriptionError):
        assert parse_markup(f"<r>{text}</r>").tag == "r"


def test_hexadecimal_and_odd_numbers():
    root = parse_markup("<a><x>0x1F</x><y>-0xff</y><z>1_0</z><c>1, 2, 3</c></a>", "w.sdf")
    assert (root.number_of("x", default=0), root.number_of("y", default=0)) == (31, -255)
    with pytest.raises(DescriptionError, match="should be a number, got '1_0'"):
        root.number_of("z", default=0)
    with pytest.raises(DescriptionError, match=r"^w\.sdf:1: <c>: the text should be a number, got '1,'"):
        root.vector_of("c", size=3, default=(0, 0, 0))


def test_errors_read_as_one_line():
    element = parse_markup("<robot>\n<joint name='elbow'/></robot>", "arm.urdf").require("joint")
    assert str(element.error("needs <limit>")) == 'arm.urdf:2: <joint name="elbow">: needs <limit>'


@pytest.mark.parametrize("text", ["x", "", "nan", "1 2"])
def test_a_number_must_be_one(text):
    with pytest.raises(DescriptionError, match="should be a"):
        parse_markup(f"<a r='{text}'/>").number_attribute("r")


def test_numbers_vectors_and_flags():
    root = parse_markup("<a><x> 1.5 </x><v>1 2\n 3</v><y>True</y><n> 0 </n><e/></a>")
    assert root.number_of("x", default=0) == 1.5
    assert root.number_of("missing", "x", default=0) == 1.5
    assert root.vector_of("v", size=3, default=(0, 0, 0)) == (1, 2, 3)
    assert root.flag_of("y", default=False) is True
    assert root.flag_of("n", default=True) is False
    assert root.number_of("e", default=7) == 7
    with pytest.raises(DescriptionError, match="should be 2 numbers"):
        root.vector_of("v", size=2, default=(0, 0))
    with pytest.raises(DescriptionError, match="expected true or false"):
        root.flag_of("x", default=False)
    with pytest.raises(DescriptionError, match="expected an integer"):
        root.integer_of("x", default=0)
