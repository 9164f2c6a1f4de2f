// Logging macros: RCLCPP_<SEVERITY>[_STREAM][_ONCE|_SKIPFIRST|_EXPRESSION|_FUNCTION|_THROTTLE|_SKIPFIRST_THROTTLE].
#ifndef RCLCPP__LOGGING_HPP_
#define RCLCPP__LOGGING_HPP_

#include <cstdint>
#include <limits>
#include <sstream>

#include "rclcpp/clock.hpp"
#include "rclcpp/logger.hpp"

namespace daidalos
{
/// Decides how often a place in the program logs.
struct LogGate
{
  bool once() {return calls++ == 0;}
  bool skip_first() {return calls++ != 0;}
  bool throttle(rclcpp::Clock & clock, double period_ms)
  {
    const std::int64_t now = clock.now().nanoseconds();
    const double passed_ms = static_cast<double>(now - last_ns) / 1e6;
    if (logged && now >= last_ns && passed_ms < period_ms) {
      return false;
    }
    logged = true;
    last_ns = now;
    return true;
  }
  std::uint64_t calls = 0;
  std::int64_t last_ns = 0;
  bool logged = false;
};
inline const char * log_format(const char * text) {return text;}
}  // namespace daidalos

#define DAIDALOS_LOG(severity, logger, condition, text) \
  do { \
    static daidalos::LogGate daidalos_gate; \
    (void)daidalos_gate; \
    const rclcpp::Logger & daidalos_logger = (logger); \
    if (daidalos::log_enabled(daidalos_logger, severity) && (condition)) { \
      daidalos::log_text(daidalos_logger, severity, (text), __FILE__, __func__, __LINE__); \
    } \
  } while (false)

#define DAIDALOS_STREAM_TEXT(stream) (static_cast<const std::ostringstream &>(std::ostringstream() << stream).str())

#define DAIDALOS_LOG_STREAM(severity, logger, stream) \
  DAIDALOS_LOG(severity, logger, true, DAIDALOS_STREAM_TEXT(stream))
#define DAIDALOS_LOG_ONCE(severity, logger, ...) \
  DAIDALOS_LOG(severity, logger, daidalos_gate.once(), daidalos::format(__VA_ARGS__))
#define DAIDALOS_LOG_STREAM_ONCE(severity, logger, stream) \
  DAIDALOS_LOG(severity, logger, daidalos_gate.once(), DAIDALOS_STREAM_TEXT(stream))
#define DAIDALOS_LOG_SKIPFIRST(severity, logger, ...) \
  DAIDALOS_LOG(severity, logger, daidalos_gate.skip_first(), daidalos::format(__VA_ARGS__))
#define DAIDALOS_LOG_STREAM_SKIPFIRST(severity, logger, stream) \
  DAIDALOS_LOG(severity, logger, daidalos_gate.skip_first(), DAIDALOS_STREAM_TEXT(stream))
#define DAIDALOS_LOG_EXPRESSION(severity, logger, expression, ...) \
  DAIDALOS_LOG(severity, logger, (expression), daidalos::format(__VA_ARGS__))
#define DAIDALOS_LOG_STREAM_EXPRESSION(severity, logger, expression, stream) \
  DAIDALOS_LOG(severity, logger, (expression), DAIDALOS_STREAM_TEXT(stream))
#define DAIDALOS_LOG_FUNCTION(severity, logger, function, ...) \
  DAIDALOS_LOG(severity, logger, (function)(), daidalos::format(__VA_ARGS__))
#define DAIDALOS_LOG_STREAM_FUNCTION(severity, logger, function, stream) \
  DAIDALOS_LOG(severity, logger, (function)(), DAIDALOS_STREAM_TEXT(stream))
#define DAIDALOS_LOG_THROTTLE(severity, logger, clock, duration, ...) \
  DAIDALOS_LOG(severity, logger, daidalos_gate.throttle(clock, static_cast<double>(duration)), daidalos::format(__VA_ARGS__))
#define DAIDALOS_LOG_STREAM_THROTTLE(severity, logger, clock, duration, stream) \
  DAIDALOS_LOG(severity, logger, daidalos_gate.throttle(clock, static_cast<double>(duration)), DAIDALOS_STREAM_TEXT(stream))
#define DAIDALOS_LOG_SKIPFIRST_THROTTLE(severity, logger, clock, duration, ...) \
  DAIDALOS_LOG(severity, logger, daidalos_gate.skip_first() && daidalos_gate.throttle(clock, static_cast<double>(duration)), daidalos::format(__VA_ARGS__))
#define DAIDALOS_LOG_STREAM_SKIPFIRST_THROTTLE(severity, logger, clock, duration, stream) \
  DAIDALOS_LOG(severity, logger, daidalos_gate.skip_first() && daidalos_gate.throttle(clock, static_cast<double>(duration)), DAIDALOS_STREAM_TEXT(stream))

#define RCLCPP_DEBUG(logger, ...) \
  DAIDALOS_LOG(RCUTILS_LOG_SEVERITY_DEBUG, logger, true, daidalos::format(__VA_ARGS__))
#define RCLCPP_DEBUG_STREAM(logger, stream) \
  DAIDALOS_LOG_STREAM(RCUTILS_LOG_SEVERITY_DEBUG, logger, stream)
#define RCLCPP_DEBUG_ONCE(logger, ...) \
  DAIDALOS_LOG_ONCE(RCUTILS_LOG_SEVERITY_DEBUG, logger, __VA_ARGS__)
#define RCLCPP_DEBUG_STREAM_ONCE(logger, stream) \
  DAIDALOS_LOG_STREAM_ONCE(RCUTILS_LOG_SEVERITY_DEBUG, logger, stream)
#define RCLCPP_DEBUG_SKIPFIRST(logger, ...) \
  DAIDALOS_LOG_SKIPFIRST(RCUTILS_LOG_SEVERITY_DEBUG, logger, __VA_ARGS__)
#define RCLCPP_DEBUG_STREAM_SKIPFIRST(logger, stream) \
  DAIDALOS_LOG_STREAM_SKIPFIRST(RCUTILS_LOG_SEVERITY_DEBUG, logger, stream)
#define RCLCPP_DEBUG_EXPRESSION(logger, ...) \
  DAIDALOS_LOG_EXPRESSION(RCUTILS_LOG_SEVERITY_DEBUG, logger, __VA_ARGS__)
#define RCLCPP_DEBUG_STREAM_EXPRESSION(logger, expression, stream) \
  DAIDALOS_LOG_STREAM_EXPRESSION(RCUTILS_LOG_SEVERITY_DEBUG, logger, expression, stream)
#define RCLCPP_DEBUG_FUNCTION(logger, ...) \
  DAIDALOS_LOG_FUNCTION(RCUTILS_LOG_SEVERITY_DEBUG, logger, __VA_ARGS__)
#define RCLCPP_DEBUG_STREAM_FUNCTION(logger, function, stream) \
  DAIDALOS_LOG_STREAM_FUNCTION(RCUTILS_LOG_SEVERITY_DEBUG, logger, function, stream)
#define RCLCPP_DEBUG_THROTTLE(logger, ...) \
  DAIDALOS_LOG_THROTTLE(RCUTILS_LOG_SEVERITY_DEBUG, logger, __VA_ARGS__)
#define RCLCPP_DEBUG_STREAM_THROTTLE(logger, clock, duration, stream) \
  DAIDALOS_LOG_STREAM_THROTTLE(RCUTILS_LOG_SEVERITY_DEBUG, logger, clock, duration, stream)
#define RCLCPP_DEBUG_SKIPFIRST_THROTTLE(logger, ...) \
  DAIDALOS_LOG_SKIPFIRST_THROTTLE(RCUTILS_LOG_SEVERITY_DEBUG, logger, __VA_ARGS__)
#define RCLCPP_DEBUG_STREAM_SKIPFIRST_THROTTLE(logger, clock, duration, stream) \
  DAIDALOS_LOG_STREAM_SKIPFIRST_THROTTLE(RCUTILS_LOG_SEVERITY_DEBUG, logger, clock, duration, stream)
#define RCLCPP_INFO(logger, ...) \
  DAIDALOS_LOG(RCUTILS_LOG_SEVERITY_INFO, logger, true, daidalos::format(__VA_ARGS__))
#define RCLCPP_INFO_STREAM(logger, stream) \
  DAIDALOS_LOG_STREAM(RCUTILS_LOG_SEVERITY_INFO, logger, stream)
#define RCLCPP_INFO_ONCE(logger, ...) \
  DAIDALOS_LOG_ONCE(RCUTILS_LOG_SEVERITY_INFO, logger, __VA_ARGS__)
#define RCLCPP_INFO_STREAM_ONCE(logger, stream) \
  DAIDALOS_LOG_STREAM_ONCE(RCUTILS_LOG_SEVERITY_INFO, logger, stream)
#define RCLCPP_INFO_SKIPFIRST(logger, ...) \
  DAIDALOS_LOG_SKIPFIRST(RCUTILS_LOG_SEVERITY_INFO, logger, __VA_ARGS__)
#define RCLCPP_INFO_STREAM_SKIPFIRST(logger, stream) \
  DAIDALOS_LOG_STREAM_SKIPFIRST(RCUTILS_LOG_SEVERITY_INFO, logger, stream)
#define RCLCPP_INFO_EXPRESSION(logger, ...) \
  DAIDALOS_LOG_EXPRESSION(RCUTILS_LOG_SEVERITY_INFO, logger, __VA_ARGS__)
#define RCLCPP_INFO_STREAM_EXPRESSION(logger, expression, stream) \
  DAIDALOS_LOG_STREAM_EXPRESSION(RCUTILS_LOG_SEVERITY_INFO, logger, expression, stream)
#define RCLCPP_INFO_FUNCTION(logger, ...) \
  DAIDALOS_LOG_FUNCTION(RCUTILS_LOG_SEVERITY_INFO, logger, __VA_ARGS__)
#define RCLCPP_INFO_STREAM_FUNCTION(logger, function, stream) \
  DAIDALOS_LOG_STREAM_FUNCTION(RCUTILS_LOG_SEVERITY_INFO, logger, function, stream)
#define RCLCPP_INFO_THROTTLE(logger, ...) \
  DAIDALOS_LOG_THROTTLE(RCUTILS_LOG_SEVERITY_INFO, logger, __VA_ARGS__)
#define RCLCPP_INFO_STREAM_THROTTLE(logger, clock, duration, stream) \
  DAIDALOS_LOG_STREAM_THROTTLE(RCUTILS_LOG_SEVERITY_INFO, logger, clock, duration, stream)
#define RCLCPP_INFO_SKIPFIRST_THROTTLE(logger, ...) \
  DAIDALOS_LOG_SKIPFIRST_THROTTLE(RCUTILS_LOG_SEVERITY_INFO, logger, __VA_ARGS__)
#define RCLCPP_INFO_STREAM_SKIPFIRST_THROTTLE(logger, clock, duration, stream) \
  DAIDALOS_LOG_STREAM_SKIPFIRST_THROTTLE(RCUTILS_LOG_SEVERITY_INFO, logger, clock, duration, stream)
#define RCLCPP_WARN(logger, ...) \
  DAIDALOS_LOG(RCUTILS_LOG_SEVERITY_WARN, logger, true, daidalos::format(__VA_ARGS__))
#define RCLCPP_WARN_STREAM(logger, stream) \
  DAIDALOS_LOG_STREAM(RCUTILS_LOG_SEVERITY_WARN, logger, stream)
#define RCLCPP_WARN_ONCE(logger, ...) \
  DAIDALOS_LOG_ONCE(RCUTILS_LOG_SEVERITY_WARN, logger, __VA_ARGS__)
#define RCLCPP_WARN_STREAM_ONCE(logger, stream) \
  DAIDALOS_LOG_STREAM_ONCE(RCUTILS_LOG_SEVERITY_WARN, logger, stream)
#define RCLCPP_WARN_SKIPFIRST(logger, ...) \
  DAIDALOS_LOG_SKIPFIRST(RCUTILS_LOG_SEVERITY_WARN, logger, __VA_ARGS__)
#define RCLCPP_WARN_STREAM_SKIPFIRST(logger, stream) \
  DAIDALOS_LOG_STREAM_SKIPFIRST(RCUTILS_LOG_SEVERITY_WARN, logger, stream)
#define RCLCPP_WARN_EXPRESSION(logger, ...) \
  DAIDALOS_LOG_EXPRESSION(RCUTILS_LOG_SEVERITY_WARN, logger, __VA_ARGS__)
#define RCLCPP_WARN_STREAM_EXPRESSION(logger, expression, stream) \
  DAIDALOS_LOG_STREAM_EXPRESSION(RCUTILS_LOG_SEVERITY_WARN, logger, expression, stream)
#define RCLCPP_WARN_FUNCTION(logger, ...) \
  DAIDALOS_LOG_FUNCTION(RCUTILS_LOG_SEVERITY_WARN, logger, __VA_ARGS__)
#define RCLCPP_WARN_STREAM_FUNCTION(logger, function, stream) \
  DAIDALOS_LOG_STREAM_FUNCTION(RCUTILS_LOG_SEVERITY_WARN, logger, function, stream)
#define RCLCPP_WARN_THROTTLE(logger, ...) \
  DAIDALOS_LOG_THROTTLE(RCUTILS_LOG_SEVERITY_WARN, logger, __VA_ARGS__)
#define RCLCPP_WARN_STREAM_THROTTLE(logger, clock, duration, stream) \
  DAIDALOS_LOG_STREAM_THROTTLE(RCUTILS_LOG_SEVERITY_WARN, logger, clock, duration, stream)
#define RCLCPP_WARN_SKIPFIRST_THROTTLE(logger, ...) \
  DAIDALOS_LOG_SKIPFIRST_THROTTLE(RCUTILS_LOG_SEVERITY_WARN, logger, __VA_ARGS__)
#define RCLCPP_WARN_STREAM_SKIPFIRST_THROTTLE(logger, clock, duration, stream) \
  DAIDALOS_LOG_STREAM_SKIPFIRST_THROTTLE(RCUTILS_LOG_SEVERITY_WARN, logger, clock, duration, stream)
#define RCLCPP_ERROR(logger, ...) \
  DAIDALOS_LOG(RCUTILS_LOG_SEVERITY_ERROR, logger, true, daidalos::format(__VA_ARGS__))
#define RCLCPP_ERROR_STREAM(logger, stream) \
  DAIDALOS_LOG_STREAM(RCUTILS_LOG_SEVERITY_ERROR, logger, stream)
#define RCLCPP_ERROR_ONCE(logger, ...) \
  DAIDALOS_LOG_ONCE(RCUTILS_LOG_SEVERITY_ERROR, logger, __VA_ARGS__)
#define RCLCPP_ERROR_STREAM_ONCE(logger, stream) \
  DAIDALOS_LOG_STREAM_ONCE(RCUTILS_LOG_SEVERITY_ERROR, logger, stream)
#define RCLCPP_ERROR_SKIPFIRST(logger, ...) \
  DAIDALOS_LOG_SKIPFIRST(RCUTILS_LOG_SEVERITY_ERROR, logger, __VA_ARGS__)
#define RCLCPP_ERROR_STREAM_SKIPFIRST(logger, stream) \
  DAIDALOS_LOG_STREAM_SKIPFIRST(RCUTILS_LOG_SEVERITY_ERROR, logger, stream)
#define RCLCPP_ERROR_EXPRESSION(logger, ...) \
  DAIDALOS_LOG_EXPRESSION(RCUTILS_LOG_SEVERITY_ERROR, logger, __VA_ARGS__)
#define RCLCPP_ERROR_STREAM_EXPRESSION(logger, expression, stream) \
  DAIDALOS_LOG_STREAM_EXPRESSION(RCUTILS_LOG_SEVERITY_ERROR, logger, expression, stream)
#define RCLCPP_ERROR_FUNCTION(logger, ...) \
  DAIDALOS_LOG_FUNCTION(RCUTILS_LOG_SEVERITY_ERROR, logger, __VA_ARGS__)
#define RCLCPP_ERROR_STREAM_FUNCTION(logger, function, stream) \
  DAIDALOS_LOG_STREAM_FUNCTION(RCUTILS_LOG_SEVERITY_ERROR, logger, function, stream)
#define RCLCPP_ERROR_THROTTLE(logger, ...) \
  DAIDALOS_LOG_THROTTLE(RCUTILS_LOG_SEVERITY_ERROR, logger, __VA_ARGS__)
#define RCLCPP_ERROR_STREAM_THROTTLE(logger, clock, duration, stream) \
  DAIDALOS_LOG_STREAM_THROTTLE(RCUTILS_LOG_SEVERITY_ERROR, logger, clock, duration, stream)
#define RCLCPP_ERROR_SKIPFIRST_THROTTLE(logger, ...) \
  DAIDALOS_LOG_SKIPFIRST_THROTTLE(RCUTILS_LOG_SEVERITY_ERROR, logger, __VA_ARGS__)
#define RCLCPP_ERROR_STREAM_SKIPFIRST_THROTTLE(logger, clock, duration, stream) \
  DAIDALOS_LOG_STREAM_SKIPFIRST_THROTTLE(RCUTILS_LOG_SEVERITY_ERROR, logger, clock, duration, stream)
#define RCLCPP_FATAL(logger, ...) \
  DAIDALOS_LOG(RCUTILS_LOG_SEVERITY_FATAL, logger, true, daidalos::format(__VA_ARGS__))
#define RCLCPP_FATAL_STREAM(logger, stream) \
  DAIDALOS_LOG_STREAM(RCUTILS_LOG_SEVERITY_FATAL, logger, stream)
#define RCLCPP_FATAL_ONCE(logger, ...) \
  DAIDALOS_LOG_ONCE(RCUTILS_LOG_SEVERITY_FATAL, logger, __VA_ARGS__)
#define RCLCPP_FATAL_STREAM_ONCE(logger, stream) \
  DAIDALOS_LOG_STREAM_ONCE(RCUTILS_LOG_SEVERITY_FATAL, logger, stream)
#define RCLCPP_FATAL_SKIPFIRST(logger, ...) \
  DAIDALOS_LOG_SKIPFIRST(RCUTILS_LOG_SEVERITY_FATAL, logger, __VA_ARGS__)
#define RCLCPP_FATAL_STREAM_SKIPFIRST(logger, stream) \
  DAIDALOS_LOG_STREAM_SKIPFIRST(RCUTILS_LOG_SEVERITY_FATAL, logger, stream)
#define RCLCPP_FATAL_EXPRESSION(logger, ...) \
  DAIDALOS_LOG_EXPRESSION(RCUTILS_LOG_SEVERITY_FATAL, logger, __VA_ARGS__)
#define RCLCPP_FATAL_STREAM_EXPRESSION(logger, expression, stream) \
  DAIDALOS_LOG_STREAM_EXPRESSION(RCUTILS_LOG_SEVERITY_FATAL, logger, expression, stream)
#define RCLCPP_FATAL_FUNCTION(logger, ...) \
  DAIDALOS_LOG_FUNCTION(RCUTILS_LOG_SEVERITY_FATAL, logger, __VA_ARGS__)
#define RCLCPP_FATAL_STREAM_FUNCTION(logger, function, stream) \
  DAIDALOS_LOG_STREAM_FUNCTION(RCUTILS_LOG_SEVERITY_FATAL, logger, function, stream)
#define RCLCPP_FATAL_THROTTLE(logger, ...) \
  DAIDALOS_LOG_THROTTLE(RCUTILS_LOG_SEVERITY_FATAL, logger, __VA_ARGS__)
#define RCLCPP_FATAL_STREAM_THROTTLE(logger, clock, duration, stream) \
  DAIDALOS_LOG_STREAM_THROTTLE(RCUTILS_LOG_SEVERITY_FATAL, logger, clock, duration, stream)
#define RCLCPP_FATAL_SKIPFIRST_THROTTLE(logger, ...) \
  DAIDALOS_LOG_SKIPFIRST_THROTTLE(RCUTILS_LOG_SEVERITY_FATAL, logger, __VA_ARGS__)
#define RCLCPP_FATAL_STREAM_SKIPFIRST_THROTTLE(logger, clock, duration, stream) \
  DAIDALOS_LOG_STREAM_SKIPFIRST_THROTTLE(RCUTILS_LOG_SEVERITY_FATAL, logger, clock, duration, stream)
#endif
