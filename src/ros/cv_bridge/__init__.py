"""Images as messages and as numpy arrays, the images of OpenCV."""

from .conversions import cvtColorForDisplay as cvtColorForDisplay
from .core import CvBridge as CvBridge
from .core import CvBridgeError as CvBridgeError
from .encodings import getCvType as getCvType
