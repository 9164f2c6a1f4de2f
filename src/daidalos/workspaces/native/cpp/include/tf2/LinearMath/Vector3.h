// Older name of the header.
#include "tf2/LinearMath/Vector3.hpp"  // IWYU pragma: export
