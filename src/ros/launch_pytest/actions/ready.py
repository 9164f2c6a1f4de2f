"""The action that says that tests may begin."""

from launch_testing.actions.ready import ReadyToTest as ReadyToTest
