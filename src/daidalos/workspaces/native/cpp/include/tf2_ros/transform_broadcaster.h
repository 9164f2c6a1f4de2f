// Older name of the header.
#include "tf2_ros/transform_broadcaster.hpp"  // IWYU pragma: export
