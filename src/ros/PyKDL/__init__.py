"""Vectors, rotations, frames, twists and wrenches, as in the geometry part of KDL.

Chains and solvers are not here; `daidalos.description` has kinematics.
"""

from PyKDL.frames import Frame as Frame
from PyKDL.frames import Rotation as Rotation
from PyKDL.frames import Twist as Twist
from PyKDL.frames import Vector as Vector
from PyKDL.frames import Wrench as Wrench
from PyKDL.functions import Equal as Equal
from PyKDL.functions import addDelta as addDelta
from PyKDL.functions import diff as diff
from PyKDL.functions import dot as dot
