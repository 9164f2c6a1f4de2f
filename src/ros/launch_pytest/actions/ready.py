"""The action that marks a launch as ready for its tests."""

from launch_testing.actions.ready import ReadyToTest as ReadyToTest
