"""Common parts of Nav2's packages; `launch` is for launch files."""
