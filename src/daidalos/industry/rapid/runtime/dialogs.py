"""Predefined routines on the operator's screen."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from daidalos.industry.rapid.runtime.errors import RapidError
from daidalos.industry.rapid.runtime.registry import routine
from daidalos.industry.rapid.runtime.values import number_text, text_of

if TYPE_CHECKING:
    from daidalos.industry.rapid.runtime.task import Task

MAX_TRIES = 3
BUTTONS = {
    0.0: (("OK",), (1.0,)),
    1.0: (("Abort", "Retry", "Ignore"), (2.0, 3.0, 4.0)),
    2.0: (("OK", "Cancel"), (1.0, 5.0)),
    3.0: (("Retry", "Cancel"), (3.0, 5.0)),
    4.0: (("Yes", "No"), (6.0, 7.0)),
    5.0: (("Yes", "No", "Cancel"), (6.0, 7.0, 5.0)),
}
"""Texts of the buttons by buttondata, and the btnres of each."""


@routine("TPWrite")
def tp_write(
    task: Task,
    string_: str,
    num_: float | None = None,
    bool_: bool | None = None,
    pos_: Any = None,
    orient_: Any = None,
    dnum_: float | None = None,
) -> None:
    """Show a line, with a value behind it."""
    value = next((one for one in (num_, bool_, pos_, orient_, dnum_) if one is not None), None)
    task.pendant.write(string_ + (text_of(value) if value is not None else ""))
    task.pass_time(0.0)


@routine("TPErase")
def tp_erase(task: Task) -> None:
    """Clear the screen."""
    task.pendant.erase()


@routine("TPShow")
def tp_show(task: Task, window_: float) -> None:
    """Choose a window of the pendant; here there is one."""


@routine("ErrWrite")
def err_write(
    task: Task,
    header_: str,
    reason_: str,
    w_: Any = None,
    i_: Any = None,
    rl2_: str | None = None,
    rl3_: str | None = None,
    rl4_: str | None = None,
) -> None:
    """Show an entry of the error log."""
    word = "warning" if w_ else "information" if i_ else "error"
    lines = [one for one in (reason_, rl2_, rl3_, rl4_) if one]
    task.pendant.write(f"{word}: {header_}: {' '.join(lines)}")
    task.pass_time(0.0)


@routine("SkipWarn")
def skip_warn(task: Task) -> None:
    """Leave an error out of the log; here only those that stop a program are in it."""


@routine("TPReadNum", "TPReadDnum")
def tp_read_num(task: Task, tpanswer_: Any, tptext_: str, **rest: Any) -> None:
    """Ask for a number."""
    tpanswer_[0][tpanswer_[1]] = _ask_number(task, tptext_)


@routine("TPReadFK")
def tp_read_key(
    task: Task,
    tpanswer_: Any,
    tptext_: str,
    tpfk1_: str,
    tpfk2_: str,
    tpfk3_: str,
    tpfk4_: str,
    tpfk5_: str,
    **rest: Any,
) -> None:
    """Ask for one of five keys, of which empty ones cannot be chosen."""
    keys = (tpfk1_, tpfk2_, tpfk3_, tpfk4_, tpfk5_)
    tpanswer_[0][tpanswer_[1]] = float(_ask_choice(task, tptext_, keys))


@routine("UINumEntry", "UIDnumEntry")
def ui_num_entry(
    task: Task,
    header_: str | None = None,
    message_: str | None = None,
    minvalue_: float | None = None,
    maxvalue_: float | None = None,
    asinteger_: Any = None,
    **rest: Any,
) -> float:
    """Return a number that the operator enters."""
    text = " ".join(one for one in (header_, message_) if one)
    for _ in range(MAX_TRIES):
        value = _ask_number(task, text)
        if asinteger_ and value != int(value):
            task.pendant.write("a whole number, please")
        elif (minvalue_ is not None and value < minvalue_) or (maxvalue_ is not None and value > maxvalue_):
            task.pendant.write("the number is out of the limits")
        else:
            return value
    raise RapidError("ERR_UI_MAXMIN", "no number within the limits was entered")


@routine("UIAlphaEntry")
def ui_alpha_entry(
    task: Task, header_: str | None = None, message_: str | None = None, initstring_: str | None = None, **rest: Any
) -> str:
    """Return a text that the operator enters."""
    answer = task.ask(" ".join(one for one in (header_, message_) if one))
    task.pass_time(0.0)
    return answer or initstring_ or ""


@routine("UIMsgBox")
def ui_message_box(
    task: Task,
    msgline1_: str,
    header_: str | None = None,
    msgline2_: str | None = None,
    msgline3_: str | None = None,
    msgline4_: str | None = None,
    msgline5_: str | None = None,
    buttons_: float | None = None,
    result_: Any = None,
    **rest: Any,
) -> None:
    """Show a message, and wait for one of its buttons."""
    text = " ".join(one for one in (header_, msgline1_, msgline2_, msgline3_, msgline4_, msgline5_) if one)
    answer = _press(task, text, buttons_ or 0.0)
    if result_ is not None:
        result_[0][result_[1]] = answer


@routine("UIMessageBox")
def ui_message(
    task: Task,
    header_: str | None = None,
    message_: str | None = None,
    msgarray_: list[str] | None = None,
    buttons_: float | None = None,
    btnarray_: list[str] | None = None,
    **rest: Any,
) -> float:
    """Return the button that the operator presses under a message."""
    text = " ".join(one for one in (header_, message_, *(msgarray_ or ())) if one)
    if btnarray_ is not None:
        return float(_ask_choice(task, text, tuple(btnarray_)))
    return _press(task, text, buttons_ or 0.0)


@routine("UIListView")
def ui_list(task: Task, listitems_: list[Any], result_: Any = None, header_: str | None = None, **rest: Any) -> float:
    """Return the place in a list that the operator chooses."""
    return float(_ask_choice(task, header_ or "", tuple(one[1] for one in listitems_)))


@routine("UIClientExist")
def ui_client_exists(task: Task) -> bool:
    """Return whether there is a screen."""
    return True


def _press(task: Task, text: str, buttons: float) -> float:
    if buttons not in BUTTONS:
        task.pendant.write(text)
        return 0.0
    texts, results = BUTTONS[buttons]
    return results[_ask_choice(task, text, texts) - 1]


def _ask_number(task: Task, text: str) -> float:
    for _ in range(MAX_TRIES):
        answer = task.ask(text)
        task.pass_time(0.0)
        try:
            return float(answer)
        except ValueError:
            task.pendant.write(f"'{answer}' is no number")
    raise RapidError("ERR_TP_NO_CLIENT", "no number was entered")


def _ask_choice(task: Task, text: str, choices: tuple[str, ...]) -> int:
    valid = {str(index): index for index, one in enumerate(choices, 1) if one}
    valid |= {one.lower(): index for index, one in enumerate(choices, 1) if one}
    for _ in range(MAX_TRIES):
        answer = task.ask(text, choices)
        task.pass_time(0.0)
        if answer.lower() in valid:
            return valid[answer.lower()]
        task.pendant.write(f"'{answer}' is none of them: {number_text(1)} to {len(choices)}")
    raise RapidError("ERR_TP_NO_CLIENT", "none of the keys was chosen")
