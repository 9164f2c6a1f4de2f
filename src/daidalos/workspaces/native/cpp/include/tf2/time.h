// Older name of the header.
#include "tf2/time.hpp"  // IWYU pragma: export
