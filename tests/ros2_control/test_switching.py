"""Which controllers can be started and stopped together."""

from collections.abc import Sequence

import pytest

from daidalos.control.errors import SwitchError
from daidalos.control.switching import Candidate, Strictness, Switch, plan_switch, update_order

HARDWARE = {"a/position", "b/position"}
CONTROLLERS = {
    "reads": Candidate("inactive", states=("a/position",)),
    "moves_a": Candidate("active", commands=("a/position",)),
    "moves_both": Candidate("inactive", commands=("a/position", "b/position")),
    "outer": Candidate("inactive", commands=("inner/x",)),
    "inner": Candidate("inactive", commands=("b/position",), references=("inner/x",)),
    "lost": Candidate("inactive", commands=("c/position",)),
    "raw": Candidate("unconfigured"),
}
CHAIN = {
    "top": Candidate("active", commands=("middle/x",)),
    "middle": Candidate("active", commands=("low/x",), references=("middle/x",)),
    "low": Candidate("active", commands=("a/position",), references=("low/x",)),
}


def plan(
    start: Sequence[str] = (),
    stop: Sequence[str] = (),
    strictness: Strictness = Strictness.STRICT,
    controllers: dict[str, Candidate] | None = None,
) -> Switch:
    known = controllers or CONTROLLERS
    return plan_switch(
        known, start, stop, strictness, lambda kind, name: "" if name in HARDWARE else f"there is no {name}"
    )


def test_free_interfaces_are_given() -> None:
    assert plan(["reads", "inner"]) == Switch((), ("inner", "reads"))
    assert plan(["moves_both"], ["moves_a"]) == Switch(("moves_a",), ("moves_both",))


@pytest.mark.parametrize(
    ("start", "stop", "message"),
    [
        (["nobody"], [], "there is no controller 'nobody'"),
        ([], ["nobody"], "there is no controller 'nobody'"),
        (["raw"], [], "'raw' is unconfigured and cannot be started"),
        (["moves_a"], [], "'moves_a' is active and cannot be started"),
        ([], ["reads"], "'reads' is inactive and cannot be stopped"),
        (["moves_both"], [], "'moves_both' needs a/position, which 'moves_a' holds"),
        (["inner", "moves_both"], ["moves_a"], "'moves_both' needs b/position, which 'inner' holds"),
        (["lost"], [], "'lost' needs c/position: there is no c/position"),
        (["outer"], [], "'outer' needs inner/x: there is no inner/x"),
    ],
)
def test_what_can_not_be_is_refused_or_left_out(start: list[str], stop: list[str], message: str) -> None:
    with pytest.raises(SwitchError, match=message):
        plan(start, stop)
    done = plan([*start, "reads"] if "reads" not in stop else start, stop, Strictness.BEST_EFFORT)
    assert any(message in reason for reason in done.left_out)
    assert "reads" in done.start or "reads" in stop


def test_a_controller_can_start_anew() -> None:
    assert plan(["moves_a"], ["moves_a"]) == Switch(("moves_a",), ("moves_a",))


def test_a_chain_starts_from_the_hardware_upwards() -> None:
    assert plan(["outer", "inner"]).start == ("inner", "outer")
    assert plan(["outer"], strictness=Strictness.AUTO).start == ("inner", "outer")


def test_a_chain_stops_from_above() -> None:
    everything = plan(stop=["low", "middle", "top"], controllers=CHAIN)
    assert everything.stop == ("top", "middle", "low")
    with pytest.raises(SwitchError, match="'low' is needed by 'middle' and cannot be stopped without it"):
        plan(stop=["low"], controllers=CHAIN)
    assert plan(stop=["low"], strictness=Strictness.BEST_EFFORT, controllers=CHAIN).stop == ()
    assert plan(stop=["low"], strictness=Strictness.FORCE_AUTO, controllers=CHAIN).stop == ("top", "middle", "low")


def test_force_auto_clears_the_way() -> None:
    assert plan(["moves_both"], strictness=Strictness.FORCE_AUTO) == Switch(("moves_a",), ("moves_both",))


def test_whoever_commands_comes_first_and_whoever_reads_last() -> None:
    controllers = {
        "reader": Candidate("active", states=("low/estimate",)),
        **{name: CHAIN[name] for name in ("low", "middle", "top")},
    }
    controllers["low"] = Candidate("active", ("a/position",), (), ("low/x",), ("low/estimate",))
    assert update_order(controllers) == ("top", "middle", "low", "reader")


def test_whoever_commands_and_reads_another_comes_first() -> None:
    controllers = {
        "low": Candidate("active", ("a/position",), (), ("low/x",), ("low/x",)),
        "top": Candidate("active", ("low/x",), ("low/x",)),
    }
    assert update_order(controllers) == ("top", "low")


def test_a_loop_of_controllers_still_has_an_order() -> None:
    loop = {
        "one": Candidate("active", commands=("two/x",), references=("one/x",)),
        "two": Candidate("active", commands=("one/x",), references=("two/x",)),
    }
    assert sorted(update_order(loop)) == ["one", "two"]
