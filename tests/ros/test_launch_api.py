"""Every public name and parameter of ROS 2 Jazzy's launch packages is there."""

import re
from pathlib import Path

import pytest

from .api_listing import faults

ELSEWHERE = {
    # Theirs alone: a conftest, and names that modules import or use on the way.
    ("launch.actions.conftest",),
    ("launch.actions.timer_action", "SomeSubstitutionsType_types_tuple"),
    ("launch.event_handlers.on_shutdown", "gen_handler"),
    ("launch.events.process.shutdown_process", "TYPE_CHECKING"),
    # A method of a class that a function makes.
    ("launch_pytest.plugin", "from_parent"),
    # Their parser is made of a grammar file.
    ("launch.frontend.parse_substitution", "ExtractSubstitution"),
    ("launch.frontend.parse_substitution", "get_grammar_path"),
    # Today's pytest hands a path by another name.
    ("launch_testing.pytest.hooks", "pytest_pycollect_makemodule", "path"),
    ("launch_testing.pytest.hooks", "pytest_launch_collect_makemodule", "path"),
    ("launch_testing.pytest.hookspecs", "pytest_launch_collect_makemodule", "path"),
}


@pytest.fixture(scope="module")
def listing(shared_data: Path) -> str:
    folder = shared_data.parent / "facts" / "api"
    if not folder.is_dir():
        pytest.skip(f"no lists of names at {folder}")
    others = re.split(r"(?m)^(?=## )", (folder / "others.txt").read_text())
    return (folder / "launch.txt").read_text() + "".join(one for one in others if one.startswith("## launch"))


def test_every_name_and_parameter_is_there(listing: str) -> None:
    assert [fault for fault in faults(listing) if fault not in ELSEWHERE] == []
