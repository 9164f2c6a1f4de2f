"""The names of the compiled part of ROS 2's own package."""

from cv_bridge.conversions import cvtColor2 as cvtColor2
from cv_bridge.conversions import cvtColorForDisplay as cvtColorForDisplay
from cv_bridge.encodings import CV_MAT_CNWrap as CV_MAT_CNWrap
from cv_bridge.encodings import CV_MAT_DEPTHWrap as CV_MAT_DEPTHWrap
from cv_bridge.encodings import getCvType as getCvType
