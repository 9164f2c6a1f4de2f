// Messages as bytes.
#ifndef RCLCPP__SERIALIZED_MESSAGE_HPP_
#define RCLCPP__SERIALIZED_MESSAGE_HPP_

#include <cstdint>
#include <string>

#include "rclcpp/macros.hpp"

struct rcl_serialized_message_t
{
  std::uint8_t * buffer = nullptr;
  std::size_t buffer_length = 0;
  std::size_t buffer_capacity = 0;
};

namespace rclcpp
{
/// CDR bytes of a message, with their header of four bytes.
class SerializedMessage
{
public:
  RCLCPP_SMART_PTR_DEFINITIONS(SerializedMessage)
  SerializedMessage() = default;
  explicit SerializedMessage(std::size_t capacity) {data_.reserve(capacity);}
  explicit SerializedMessage(std::string data) : data_(std::move(data)) {}
  std::size_t size() const {return data_.size();}
  std::size_t capacity() const {return data_.capacity();}
  void reserve(std::size_t capacity) {data_.reserve(capacity);}
  const std::string & bytes() const {return data_;}
  std::string & bytes() {return data_;}
  const rcl_serialized_message_t & get_rcl_serialized_message() const
  {
    view_.buffer = reinterpret_cast<std::uint8_t *>(data_.data());
    view_.buffer_length = data_.size();
    view_.buffer_capacity = data_.capacity();
    return view_;
  }

private:
  mutable std::string data_;
  mutable rcl_serialized_message_t view_;
};
}  // namespace rclcpp
#endif
