"""Predefined functions on numbers and bits; angles are in degrees."""

from __future__ import annotations

import math
from collections.abc import Callable
from decimal import ROUND_HALF_UP, Decimal
from typing import TYPE_CHECKING, Any

from daidalos.industry.rapid.runtime.errors import RapidError
from daidalos.industry.rapid.runtime.registry import routine

if TYPE_CHECKING:
    from daidalos.industry.rapid.runtime.task import Task

MAX_BIT = 8
MAX_BIT_DNUM = 52


@routine("Abs", "AbsDnum")
def absolute(task: Task, value_: float) -> float:
    """Return the absolute value."""
    return abs(value_)


@routine("Sin", "SinDnum")
def sine(task: Task, angle_: float) -> float:
    """Return the sine."""
    return math.sin(math.radians(angle_))


@routine("Cos", "CosDnum")
def cosine(task: Task, angle_: float) -> float:
    """Return the cosine."""
    return math.cos(math.radians(angle_))


@routine("Tan", "TanDnum")
def tangent(task: Task, angle_: float) -> float:
    """Return the tangent."""
    return math.tan(math.radians(angle_))


@routine("ASin", "ASinDnum")
def arc_sine(task: Task, value_: float) -> float:
    """Return the angle of a sine."""
    return math.degrees(math.asin(_within_one("ASin", value_)))


@routine("ACos", "ACosDnum")
def arc_cosine(task: Task, value_: float) -> float:
    """Return the angle of a cosine."""
    return math.degrees(math.acos(_within_one("ACos", value_)))


def _within_one(name: str, value: float) -> float:
    if not -1.0 <= value <= 1.0:
        raise RapidError("ERR_ARGVALERR", f"{name} takes -1 to 1, not {value:g}")
    return value


@routine("ATan", "ATanDnum")
def arc_tangent(task: Task, value_: float) -> float:
    """Return the angle of a tangent, -90 to 90."""
    return math.degrees(math.atan(value_))


@routine("ATan2", "ATan2Dnum")
def arc_tangent_2(task: Task, y_: float, x_: float) -> float:
    """Return the angle of a point, -180 to 180."""
    return math.degrees(math.atan2(y_, x_))


@routine("Sqrt", "SqrtDnum")
def square_root(task: Task, value_: float) -> float:
    """Return the square root."""
    if value_ < 0:
        raise RapidError("ERR_ARGVALERR", f"there is no square root of {value_:g}")
    return math.sqrt(value_)


@routine("Exp")
def exponential(task: Task, exponent_: float) -> float:
    """Return e to the power of a number."""
    return math.exp(exponent_)


@routine("Pow", "PowDnum")
def power(task: Task, base_: float, exponent_: float) -> float:
    """Return a number to the power of another."""
    result = base_**exponent_
    if isinstance(result, complex):
        raise RapidError("ERR_ARGVALERR", f"{base_:g} to the power of {exponent_:g} is no real number")
    return float(result)


@routine("Round", "RoundDnum")
def rounded(task: Task, val_: float, dec_: float | None = None) -> float:
    """Return a number with so many decimals, halves away from 0."""
    return float(Decimal(repr(val_)).quantize(Decimal(1).scaleb(-int(dec_ or 0)), ROUND_HALF_UP))


@routine("Trunc", "TruncDnum")
def truncated(task: Task, val_: float, dec_: float | None = None) -> float:
    """Return a number cut to so many decimals."""
    scale = 10.0 ** int(dec_ or 0)
    return math.trunc(val_ * scale) / scale


@routine("Max")
def maximum(task: Task, value1_: float, value2_: float) -> float:
    """Return the larger number."""
    return max(value1_, value2_)


@routine("Min")
def minimum(task: Task, value1_: float, value2_: float) -> float:
    """Return the smaller number."""
    return min(value1_, value2_)


@routine("NumToDnum")
def num_to_dnum(task: Task, value_: float) -> float:
    """Return a num as dnum."""
    return value_


@routine("DnumToNum")
def dnum_to_num(task: Task, value_: float, integer_: Any = None) -> float:
    """Return a dnum as num."""
    if integer_ and value_ != int(value_):
        raise RapidError("ERR_ARGVALERR", f"{value_:g} is no whole number")
    return value_


@routine("Incr")
def increment(task: Task, name_: Any) -> None:
    """Add 1."""
    name_[0][name_[1]] += 1.0


@routine("Decr")
def decrement(task: Task, name_: Any) -> None:
    """Subtract 1."""
    name_[0][name_[1]] -= 1.0


@routine("Add")
def add(task: Task, name_: Any, addvalue_: float) -> None:
    """Add a number."""
    name_[0][name_[1]] += addvalue_


@routine("Clear")
def clear(task: Task, name_: Any) -> None:
    """Set to 0."""
    name_[0][name_[1]] = 0.0


@routine("TryInt")
def try_int(task: Task, dataobj_: float) -> None:
    """Check that a number is whole."""
    if dataobj_ != int(dataobj_):
        raise RapidError("ERR_INT_NOTVAL", f"{dataobj_:g} is no whole number")


# Bits


def _whole(value: float, bits: int) -> int:
    if value != int(value) or not 0 <= value < 2**bits:
        raise RapidError("ERR_ARGVALERR", f"{value:g} is no whole number from 0 to {2**bits - 1}")
    return int(value)


def _define(name: str, operate: Callable[[int, int], int]) -> None:
    def byte(task: Task, bitdata1_: float, bitdata2_: float) -> float:
        return float(operate(_whole(bitdata1_, MAX_BIT), _whole(bitdata2_, MAX_BIT)))

    def dnum(task: Task, value1_: float, value2_: float) -> float:
        return float(operate(_whole(value1_, MAX_BIT_DNUM), _whole(value2_, MAX_BIT_DNUM)))

    routine(name)(byte)
    routine(f"{name}Dnum")(dnum)


_define("BitAnd", lambda a, b: a & b)
_define("BitOr", lambda a, b: a | b)
_define("BitXOr", lambda a, b: a ^ b)


@routine("BitNeg")
def bit_not(task: Task, bitdata_: float) -> float:
    """Return a byte with each bit inverted."""
    return float(~_whole(bitdata_, MAX_BIT) & 0xFF)


@routine("BitLSh")
def shift_left(task: Task, bitdata_: float, shiftsteps_: float) -> float:
    """Return a byte shifted to the left."""
    return float(_whole(bitdata_, MAX_BIT) << int(shiftsteps_) & 0xFF)


@routine("BitRSh")
def shift_right(task: Task, bitdata_: float, shiftsteps_: float) -> float:
    """Return a byte shifted to the right."""
    return float(_whole(bitdata_, MAX_BIT) >> int(shiftsteps_))


@routine("BitLShDnum")
def shift_left_dnum(task: Task, value_: float, shiftsteps_: float) -> float:
    """Return a dnum shifted to the left."""
    return float(_whole(value_, MAX_BIT_DNUM) << int(shiftsteps_) & 2**MAX_BIT_DNUM - 1)


@routine("BitRShDnum")
def shift_right_dnum(task: Task, value_: float, shiftsteps_: float) -> float:
    """Return a dnum shifted to the right."""
    return float(_whole(value_, MAX_BIT_DNUM) >> int(shiftsteps_))


@routine("BitCheck")
def bit_check(task: Task, bitdata_: float, bitpos_: float) -> bool:
    """Return whether a bit of a byte is 1; the first bit is 1."""
    return bool(_whole(bitdata_, MAX_BIT) >> _position(bitpos_, MAX_BIT) & 1)


@routine("BitCheckDnum")
def bit_check_dnum(task: Task, value_: float, bitpos_: float) -> bool:
    """Return whether a bit of a dnum is 1; the first bit is 1."""
    return bool(_whole(value_, MAX_BIT_DNUM) >> _position(bitpos_, MAX_BIT_DNUM) & 1)


@routine("BitSet")
def bit_set(task: Task, bitdata_: Any, bitpos_: float) -> None:
    """Set a bit."""
    value = _whole(bitdata_[0][bitdata_[1]], MAX_BIT_DNUM)
    bitdata_[0][bitdata_[1]] = float(value | 1 << _position(bitpos_, MAX_BIT_DNUM))


@routine("BitClear")
def bit_clear(task: Task, bitdata_: Any, bitpos_: float) -> None:
    """Clear a bit."""
    value = _whole(bitdata_[0][bitdata_[1]], MAX_BIT_DNUM)
    bitdata_[0][bitdata_[1]] = float(value & ~(1 << _position(bitpos_, MAX_BIT_DNUM)))


def _position(position: float, bits: int) -> int:
    if not 1 <= position <= bits:
        raise RapidError("ERR_ARGVALERR", f"there is no bit {position:g}; they count from 1 to {bits}")
    return int(position) - 1
