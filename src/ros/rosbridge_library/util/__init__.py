"""What the protocol's parts share."""

import json as json
