// Older name of the header.
#include "tf2/exceptions.hpp"  // IWYU pragma: export
