// Older name of the header.
#include "tf2/LinearMath/Matrix3x3.hpp"  // IWYU pragma: export
