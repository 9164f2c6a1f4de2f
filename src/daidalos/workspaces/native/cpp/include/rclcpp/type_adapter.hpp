// Types of a program's own that are published and received as messages.
#ifndef RCLCPP__TYPE_ADAPTER_HPP_
#define RCLCPP__TYPE_ADAPTER_HPP_

#include <type_traits>

namespace rclcpp
{
/// Specialized by programs, with `is_specialized` and the two conversions.
template<typename CustomType, typename ROSMessageType = void, typename Enable = void>
struct TypeAdapter
{
  using is_specialized = std::false_type;
  using custom_type = CustomType;
  using ros_message_type = CustomType;
};
/// An adapter may stand for itself: create_publisher<TypeAdapter<std::string, String>>().
template<typename CustomType, typename ROSMessageType>
struct TypeAdapter<TypeAdapter<CustomType, ROSMessageType>, void,
  std::enable_if_t<!std::is_void<ROSMessageType>::value>>: TypeAdapter<CustomType, ROSMessageType>
{
};
template<typename CustomType, typename ROSMessageType>
using adapt_type = TypeAdapter<CustomType, ROSMessageType>;
}  // namespace rclcpp
#endif
