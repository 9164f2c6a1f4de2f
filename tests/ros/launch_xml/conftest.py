"""Each test has its own log files and environment."""

from ros.launching import run_text, sandbox

__all__ = ["run_text", "sandbox"]
