// Older name of the header.
#include "tf2/LinearMath/Transform.hpp"  // IWYU pragma: export
