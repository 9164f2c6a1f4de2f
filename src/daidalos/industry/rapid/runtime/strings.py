"""Predefined functions on strings."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from daidalos.industry.rapid.runtime.errors import RapidError
from daidalos.industry.rapid.runtime.registry import routine
from daidalos.industry.rapid.runtime.values import checked_string, text_of, value_of_text

if TYPE_CHECKING:
    from daidalos.industry.rapid.runtime.task import Task


@routine("StrLen")
def length(task: Task, str_: str) -> float:
    """Return the number of characters."""
    return float(len(str_))


@routine("StrPart")
def part(task: Task, str_: str, chpos_: float, len_: float) -> str:
    """Return so many characters from a position on, which counts from 1."""
    start, count = int(chpos_), int(len_)
    if start < 1 or count < 0 or start - 1 + count > len(str_):
        raise RapidError("ERR_OUTOFBND", f"a string of {len(str_)} has no {count} from {start} on")
    return str_[start - 1 : start - 1 + count]


@routine("StrFind")
def find(task: Task, str_: str, chpos_: float, set_: str, notinset_: Any = None) -> float:
    """Return the first position from one on with a character that is, or is not, in a set; else the length plus 1."""
    _check_position(str_, chpos_)
    for index in range(int(chpos_) - 1, len(str_)):
        if (str_[index] in set_) != bool(notinset_):
            return float(index + 1)
    return float(len(str_) + 1)


@routine("StrMatch")
def match(task: Task, str_: str, chpos_: float, pattern_: str) -> float:
    """Return the first position from one on that a text stands at; else the length plus 1."""
    _check_position(str_, chpos_)
    found = str_.find(pattern_, int(chpos_) - 1)
    return float(found + 1 if found >= 0 else len(str_) + 1)


@routine("StrMemb")
def is_member(task: Task, str_: str, chpos_: float, set_: str) -> bool:
    """Return whether the character at a position is in a set."""
    _check_position(str_, chpos_)
    return str_[int(chpos_) - 1 : int(chpos_)] in set_


def _check_position(text: str, position: float) -> None:
    if not 1 <= position <= len(text) + 1:
        raise RapidError("ERR_OUTOFBND", f"a string of {len(text)} characters has no position {position:g}")


@routine("StrMap")
def mapped(task: Task, str_: str, frommap_: str, tomap_: str) -> str:
    """Return a string with characters replaced by others."""
    if len(frommap_) != len(tomap_):
        raise RapidError("ERR_ARGVALERR", "the two maps of StrMap have different lengths")
    return str_.translate(str.maketrans(frommap_, tomap_))


@routine("StrOrder")
def is_ordered(task: Task, str1_: str, str2_: str, order_: str) -> bool:
    """Return whether a string comes before another, or is the same, in an order of characters."""
    places = {character: index for index, character in reversed(list(enumerate(order_)))}

    def key(text: str) -> list[tuple[int, str]]:
        return [(places.get(one, len(order_) + ord(one)), one) for one in text]

    return key(str1_) <= key(str2_)


@routine("StrFormat")
def formatted(
    task: Task,
    format_: str,
    arg1_: str | None = None,
    arg2_: str | None = None,
    arg3_: str | None = None,
    arg4_: str | None = None,
    arg5_: str | None = None,
    arg6_: str | None = None,
) -> str:
    """Return a text with {1} to {6} replaced by arguments."""
    for index, argument in enumerate((arg1_, arg2_, arg3_, arg4_, arg5_, arg6_), 1):
        format_ = format_.replace(f"{{{index}}}", argument or "")
    return checked_string(format_)


@routine("NumToStr", "DnumToStr")
def from_number(task: Task, val_: float, dec_: float, exp_: Any = None) -> str:
    """Return a number with so many decimals."""
    if exp_:
        mantissa, exponent = f"{val_:.{int(dec_)}E}".split("E")
        return f"{mantissa}E{int(exponent):+03d}"
    return f"{val_:.{int(dec_)}f}"


@routine("ValToStr")
def from_value(task: Task, val_: Any) -> str:
    """Return a value as a program has it; a string with its quotes."""
    return checked_string(text_of(val_))


@routine("StrToVal")
def to_value(task: Task, str_: str, val_: Any) -> bool:
    """Return whether a text is a value of the type of data, which then gets it."""
    is_reference = isinstance(val_, tuple)
    like = val_[0][val_[1]] if is_reference else val_
    text = str_.strip()
    if isinstance(like, str) and not text.startswith('"'):
        text = '"' + text.replace('"', '""') + '"'
    try:
        value = value_of_text(text, like)
    except (ValueError, IndexError):
        return False
    if is_reference:
        val_[0][val_[1]] = value
    else:
        val_[:] = value
    return True


@routine("StrToByte")
def to_byte(task: Task, constr_: str, hex_: Any = None, okt_: Any = None, bin_: Any = None, char_: Any = None) -> float:
    """Return the byte that a text is of."""
    try:
        value = ord(constr_[0]) if char_ else int(constr_, 16 if hex_ else 8 if okt_ else 2 if bin_ else 10)
    except (ValueError, IndexError):
        raise RapidError("ERR_ARGVALERR", f"'{constr_}' is no byte") from None
    if not 0 <= value <= 255:
        raise RapidError("ERR_ARGVALERR", f"'{constr_}' is no byte: 0 to 255")
    return float(value)


@routine("ByteToStr")
def from_byte(
    task: Task, bytedata_: float, hex_: Any = None, okt_: Any = None, bin_: Any = None, char_: Any = None
) -> str:
    """Return a byte as text."""
    value = int(bytedata_)
    if char_:
        return chr(value)
    return f"{value:02X}" if hex_ else f"{value:03o}" if okt_ else f"{value:08b}" if bin_ else str(value)


@routine("DecToHex")
def to_hexadecimal(task: Task, str_: str) -> str:
    """Return a decimal number as a hexadecimal one."""
    return f"{_integer(str_, 10):X}"


@routine("HexToDec")
def to_decimal(task: Task, str_: str) -> str:
    """Return a hexadecimal number as a decimal one."""
    return str(_integer(str_, 16))


def _integer(text: str, base: int) -> int:
    try:
        return int(text, base)
    except ValueError:
        raise RapidError("ERR_ARGVALERR", f"'{text}' is no number") from None


@routine("StrDigCmp")
def compare_digits(task: Task, strdig1_: str, relation_: float, strdig2_: str) -> bool:
    """Return whether a relation holds between two numbers of any length."""
    a, b = _integer(strdig1_, 10), _integer(strdig2_, 10)
    return {1.0: a < b, 2.0: a <= b, 3.0: a == b, 4.0: a != b, 5.0: a >= b, 6.0: a > b}[relation_]


@routine("StrDigCalc")
def calculate_digits(task: Task, strdig1_: str, operation_: float, strdig2_: str) -> str:
    """Return the result of an operation on two numbers of any length."""
    a, b = _integer(strdig1_, 10), _integer(strdig2_, 10)
    if operation_ >= 4.0 and b == 0:
        raise RapidError("ERR_CALC_DIVZERO", "division by zero")
    results = {1.0: lambda: a + b, 2.0: lambda: a - b, 3.0: lambda: a * b, 4.0: lambda: a // b, 5.0: lambda: a % b}
    result = results[operation_]()
    if result < 0:
        raise RapidError("ERR_CALC_NEG", f"{a} - {b} is below 0")
    return str(result)


@routine("Dim")
def dimension(task: Task, arrpar_: Any, dimno_: float) -> float:
    """Return the number of elements of a dimension of an array."""
    value = arrpar_
    for _ in range(int(dimno_) - 1):
        value = value[0]
    return float(len(value))
