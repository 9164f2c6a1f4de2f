// Older name of the header.
#include "tf2/LinearMath/Quaternion.hpp"  // IWYU pragma: export
