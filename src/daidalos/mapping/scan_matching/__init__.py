"""The pose of a scan among points: correlation for the neighbourhood, point to line for the millimetres."""
