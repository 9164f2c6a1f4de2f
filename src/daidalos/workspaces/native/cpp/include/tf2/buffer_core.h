// Older name of the header.
#include "tf2/buffer_core.hpp"  // IWYU pragma: export
