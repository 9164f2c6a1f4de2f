"""What sensors measure and commands say, as dataclasses of arrays, and their messages."""
