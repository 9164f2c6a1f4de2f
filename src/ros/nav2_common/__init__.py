"""What the packages of Nav2 share; `launch` is what launch files import."""
