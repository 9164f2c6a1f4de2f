// Older name of the header.
#include "tf2_ros/transform_listener.hpp"  // IWYU pragma: export
