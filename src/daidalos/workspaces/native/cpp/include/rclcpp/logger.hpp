// Loggers.
#ifndef RCLCPP__LOGGER_HPP_
#define RCLCPP__LOGGER_HPP_

#include <string>
#include <utility>

enum RCUTILS_LOG_SEVERITY
{
  RCUTILS_LOG_SEVERITY_UNSET = 0, RCUTILS_LOG_SEVERITY_DEBUG = 10, RCUTILS_LOG_SEVERITY_INFO = 20,
  RCUTILS_LOG_SEVERITY_WARN = 30, RCUTILS_LOG_SEVERITY_ERROR = 40, RCUTILS_LOG_SEVERITY_FATAL = 50
};

namespace rclcpp
{
/// Logger by name: to the console, to a file, and to /rosout where a node has the name.
class Logger
{
public:
  enum class Level
  {
    Unset = RCUTILS_LOG_SEVERITY_UNSET, Debug = RCUTILS_LOG_SEVERITY_DEBUG, Info = RCUTILS_LOG_SEVERITY_INFO,
    Warn = RCUTILS_LOG_SEVERITY_WARN, Error = RCUTILS_LOG_SEVERITY_ERROR, Fatal = RCUTILS_LOG_SEVERITY_FATAL
  };
  explicit Logger(std::string name = "") : name_(std::move(name)) {}
  const char * get_name() const {return name_.c_str();}
  Logger get_child(const std::string & suffix) const {return Logger(name_.empty() ? suffix : name_ + "." + suffix);}
  void set_level(Level level);
  Level get_effective_level() const;

private:
  std::string name_;
};

inline Logger get_logger(const std::string & name) {return Logger(name);}
}  // namespace rclcpp

namespace daidalos
{
bool log_enabled(const rclcpp::Logger & logger, int severity);
void log_text(
  const rclcpp::Logger & logger, int severity, const std::string & text, const char * file, const char * function,
  int line);
/// Text of a printf format.
std::string format(const char * text, ...) __attribute__ ((format(printf, 1, 2)));
}  // namespace daidalos
#endif
