// How the constructor of a generated message sets its fields.
#ifndef ROSIDL_RUNTIME_CPP__MESSAGE_INITIALIZATION_HPP_
#define ROSIDL_RUNTIME_CPP__MESSAGE_INITIALIZATION_HPP_

namespace rosidl_runtime_cpp
{
/// Accepted by every message; fields always get their default, or zero.
enum class MessageInitialization {ALL, SKIP, ZERO, DEFAULTS_ONLY};
}  // namespace rosidl_runtime_cpp

#endif
