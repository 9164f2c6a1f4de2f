"""Where tests find what is not theirs."""

import tempfile
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent

MACHINE_TEMPORARY = Path(tempfile.gettempdir())
"""The machine's temporary folder, for locks between test runs; a run has another one of its own."""
