// Results of waiting for futures.
#ifndef RCLCPP__FUTURE_RETURN_CODE_HPP_
#define RCLCPP__FUTURE_RETURN_CODE_HPP_

#include <ostream>
#include <string>

namespace rclcpp
{
enum class FutureReturnCode {SUCCESS, INTERRUPTED, TIMEOUT};
inline std::string to_string(FutureReturnCode code)
{
  return code == FutureReturnCode::SUCCESS ? "SUCCESS (0)" :
         code == FutureReturnCode::INTERRUPTED ? "INTERRUPTED (1)" : "TIMEOUT (2)";
}
inline std::ostream & operator<<(std::ostream & out, FutureReturnCode code) {return out << to_string(code);}
}  // namespace rclcpp
#endif
