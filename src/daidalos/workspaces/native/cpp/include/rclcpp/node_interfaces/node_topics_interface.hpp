// The header of this name of upstream.
#pragma once
#include "daidalos/node_core.hpp"
