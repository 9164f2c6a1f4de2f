// The header of this name of upstream.
#pragma once
#include "rclcpp/executors.hpp"
