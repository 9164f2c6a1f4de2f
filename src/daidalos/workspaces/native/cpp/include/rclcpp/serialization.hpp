// Encoding and decoding of messages.
#ifndef RCLCPP__SERIALIZATION_HPP_
#define RCLCPP__SERIALIZATION_HPP_

#include "daidalos/cdr.hpp"
#include "rclcpp/serialized_message.hpp"

namespace rclcpp
{
template<typename MessageT>
class Serialization
{
public:
  void serialize_message(const void * message, SerializedMessage * serialized) const
  {
    daidalos::encode(*static_cast<const MessageT *>(message), serialized->bytes());
  }
  void deserialize_message(const SerializedMessage * serialized, void * message) const
  {
    daidalos::decode(serialized->bytes(), *static_cast<MessageT *>(message));
  }
};
}  // namespace rclcpp
#endif
