// Older name of the header.
#include "tf2/utils.hpp"  // IWYU pragma: export
