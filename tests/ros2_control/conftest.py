"""Makes the helpers of these tests importable.

The folder is not a package: its name would hide python-control from whatever imports that.
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
