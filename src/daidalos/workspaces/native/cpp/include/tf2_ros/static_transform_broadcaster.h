// Older name of the header.
#include "tf2_ros/static_transform_broadcaster.hpp"  // IWYU pragma: export
