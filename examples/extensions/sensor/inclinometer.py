"""An inclinometer: how far a link leans."""

import math

from daidalos.common.pose3 import rotate
from daidalos.samples.sensors import NumberSample
from daidalos.simulation.contracts import Sensor


class Inclinometer(Sensor):
    """The angle between the sensor's z axis and the vertical [rad], as `std_msgs/msg/Float32`.

    Child of the `<sensor>`: `<offset>` [rad] is added to what it measures.
    """

    default_topic = "inclination"

    def read(self, element):
        self.offset = element.number_of("offset", default=0.0)

    @property
    def publications(self):
        return {self.topic: NumberSample}

    def measure(self, now_ns):
        up = rotate((self.link.pose @ self.pose).orientation, (0.0, 0.0, 1.0))
        yield NumberSample(now_ns, self.topic, self.frame_id, self.offset + math.acos(min(max(up[2], -1.0), 1.0)))
