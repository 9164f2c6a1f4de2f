// What is known of a message besides its content.
#ifndef RCLCPP__MESSAGE_INFO_HPP_
#define RCLCPP__MESSAGE_INFO_HPP_

#include <array>
#include <cstdint>

struct rmw_gid_t
{
  const char * implementation_identifier = "daidalos";
  std::uint8_t data[16] = {};
};
struct rmw_message_info_t
{
  std::int64_t source_timestamp = 0;
  std::int64_t received_timestamp = 0;
  std::uint64_t publication_sequence_number = 0;
  std::uint64_t reception_sequence_number = 0;
  rmw_gid_t publisher_gid;
  bool from_intra_process = false;
};

namespace rclcpp
{
/// Metadata of a message; stamps are Unix time in nanoseconds.
class MessageInfo
{
public:
  MessageInfo() = default;
  MessageInfo(const rmw_message_info_t & info) : info_(info) {}  // NOLINT
  const rmw_message_info_t & get_rmw_message_info() const {return info_;}
  rmw_message_info_t & get_rmw_message_info() {return info_;}

private:
  rmw_message_info_t info_;
};
}  // namespace rclcpp
#endif
