"""The command lines of `ros2 control`."""

from argparse import ArgumentParser

import pytest

from daidalos.cli.ros2.control.load_controller import LoadControllerVerb


@pytest.mark.parametrize(
    ("word", "state"), [("active", "active"), ("inactive", "inactive"), ("start", "active"), ("configure", "inactive")]
)
def test_the_state_may_be_named_as_older_distributions_did(word, state):
    parser = ArgumentParser()
    LoadControllerVerb().add_arguments(parser, "load_controller")
    assert parser.parse_args(["--set-state", word, "arm"]).set_state == state
    with pytest.raises(SystemExit):
        parser.parse_args(["--set-state", "running", "arm"])
