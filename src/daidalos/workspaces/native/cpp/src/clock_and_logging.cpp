#include <cstdarg>
#include <algorithm>
#include <cstdio>
#include <sstream>
#include <thread>

#include "daidalos/bridge.hpp"
#include "daidalos/yaml.hpp"
#include "rclcpp/clock.hpp"
#include "rclcpp/logger.hpp"
#include "rclcpp/parameter_value.hpp"
#include "rclcpp/utilities.hpp"

namespace rclcpp
{
Time Clock::now() const
{
  if (simulated_) {
    return Time(simulated_ns_, type_);
  }
  const auto passed = type_ == RCL_STEADY_TIME ?
    std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch()) :
    std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch());
  return Time(passed.count(), type_);
}

bool Clock::sleep_until(Time until)
{
  while (ok()) {
    const auto left = (until - now()).to_chrono<std::chrono::nanoseconds>();
    if (left.count() <= 0) {
      return true;
    }
    // Simulated time advances by messages; how fast, nobody knows.
    if (!rclcpp::sleep_for(simulated_ ? std::min<std::chrono::nanoseconds>(left, std::chrono::milliseconds(1)) : left)) {
      return false;
    }
  }
  return false;
}

void Clock::set_simulated(bool active, std::int64_t ns)
{
  simulated_ns_ = ns;
  simulated_ = active;
  std::vector<std::function<void()>> wakes;
  {
    std::lock_guard<std::mutex> lock(mutex_);
    wakes = wakes_;
  }
  for (const auto & wake : wakes) {
    wake();
  }
}

void Clock::on_change(std::function<void()> wake)
{
  std::lock_guard<std::mutex> lock(mutex_);
  wakes_.push_back(std::move(wake));
}

void Logger::set_level(Level level)
{
  daidalos::call(daidalos::door(), "set_log_level", {name_, static_cast<int>(level)});
}

Logger::Level Logger::get_effective_level() const
{
  return static_cast<Level>(daidalos::call(daidalos::door(), "log_level", {name_}).integer());
}

std::string to_string(ParameterType type)
{
  static const char * const names[] = {
    "not set", "bool", "integer", "double", "string", "byte_array", "bool_array", "integer_array", "double_array",
    "string_array"};
  return names[type <= PARAMETER_STRING_ARRAY ? type : 0];
}

std::ostream & operator<<(std::ostream & out, ParameterType type) {return out << to_string(type);}

std::string to_string(const ParameterValue & value)
{
  const auto list = [](const auto & values) {
      std::ostringstream out;
      out << std::boolalpha << '[';
      for (std::size_t i = 0; i != values.size(); ++i) {
        out << (i ? ", " : "") << values[i];
      }
      out << ']';
      return out.str();
    };
  const auto & message = value.to_value_msg();
  switch (value.get_type()) {
    case PARAMETER_BOOL: return message.bool_value ? "true" : "false";
    case PARAMETER_INTEGER: return std::to_string(message.integer_value);
    case PARAMETER_DOUBLE: return std::to_string(message.double_value);
    case PARAMETER_STRING: return message.string_value;
    case PARAMETER_BYTE_ARRAY: return list(std::vector<int>(
        message.byte_array_value.begin(), message.byte_array_value.end()));
    case PARAMETER_BOOL_ARRAY: return list(message.bool_array_value);
    case PARAMETER_INTEGER_ARRAY: return list(message.integer_array_value);
    case PARAMETER_DOUBLE_ARRAY: return list(message.double_array_value);
    case PARAMETER_STRING_ARRAY: return list(message.string_array_value);
    default: return "not set";
  }
}
}  // namespace rclcpp

namespace daidalos
{
bool log_enabled(const rclcpp::Logger & logger, int severity)
{
  return static_cast<int>(logger.get_effective_level()) <= severity;
}

void log_text(
  const rclcpp::Logger & logger, int severity, const std::string & text, const char * file, const char * function,
  int line)
{
  call(door(), "log", {std::string(logger.get_name()), severity, text, file, function, line});
}

std::string format(const char * text, ...)
{
  va_list arguments, again;
  va_start(arguments, text);
  va_copy(again, arguments);
  const int size = vsnprintf(nullptr, 0, text, arguments);
  va_end(arguments);
  std::string result(size > 0 ? static_cast<std::size_t>(size) + 1 : 1, '\0');
  vsnprintf(result.data(), result.size(), text, again);
  va_end(again);
  result.pop_back();
  return result;
}
}  // namespace daidalos
