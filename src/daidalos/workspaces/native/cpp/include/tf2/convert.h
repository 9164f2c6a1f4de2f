// Older name of the header.
#include "tf2/convert.hpp"  // IWYU pragma: export
