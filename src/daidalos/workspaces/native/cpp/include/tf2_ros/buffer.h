// Older name of the header.
#include "tf2_ros/buffer.hpp"  // IWYU pragma: export
