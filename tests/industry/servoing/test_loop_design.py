"""Servo loops designed with python-control, beside the workshop's figures and an independent computation."""

from dataclasses import replace

import pytest

from daidalos.common.errors import UserError
from daidalos.industry.servoing.design_table import open_loop_margins, reachable, rows
from daidalos.industry.servoing.loop_design import COMPENSATORS, Compensator, LoopModel, compensator_named, design

pytest.importorskip("control")


def test_figures_that_the_workshop_prints() -> None:
    proportional, lead = (design(LoopModel(), COMPENSATORS[name]).figures for name in ("proportional", "lead"))
    assert proportional.phase_margin == pytest.approx(65.64, abs=0.01)
    assert proportional.gain_margin == pytest.approx(11.71, abs=0.01)
    assert proportional.overshoot == pytest.approx(0.61, abs=0.01)
    assert proportional.settling_time == pytest.approx(0.864, abs=0.001)
    assert lead.phase_margin == pytest.approx(65.36, abs=0.01)
    assert lead.gain_margin == pytest.approx(11.22, abs=0.01)
    assert lead.overshoot == pytest.approx(1.99, abs=0.01)
    assert lead.settling_time == pytest.approx(0.534, abs=0.001)


@pytest.mark.parametrize("name", COMPENSATORS)
def test_margins_by_the_formulas_of_the_parts(name: str) -> None:
    model = replace(LoopModel(), cycle=0.01, cutoff=40.0)
    figures = design(model, COMPENSATORS[name]).figures
    assert open_loop_margins(model, COMPENSATORS[name]) == pytest.approx(
        (figures.phase_margin, figures.gain_margin), abs=0.01
    )


def test_what_no_choice_of_the_parameters_reproduces() -> None:
    model = LoopModel()
    table = rows({name: design(model, one) for name, one in COMPENSATORS.items()}, reachable(model))
    assert {row.title for row in table if row.remark} == {
        "proportional: gain margin",
        "proportional: overshoot",
        "lead: gain margin",
    }


def test_unstable_loops_and_unknown_names_are_refused() -> None:
    with pytest.raises(UserError, match=r"not stable, it has a pole at \+"):
        design(LoopModel(), Compensator("strong", 1.0))
    with pytest.raises(UserError, match="did you mean 'lead'"):
        compensator_named("leed")
