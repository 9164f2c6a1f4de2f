"""The layers that a costmap is put together from, one class each."""
