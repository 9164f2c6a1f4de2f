// Older name of the header.
#include "tf2_geometry_msgs/tf2_geometry_msgs.hpp"  // IWYU pragma: export
