// Start and end of a program.
#ifndef RCLCPP__UTILITIES_HPP_
#define RCLCPP__UTILITIES_HPP_

#include <chrono>
#include <future>
#include <string>
#include <vector>

#include "rclcpp/context.hpp"

namespace rclcpp
{
void init(
  int argc, char const * const * argv, const InitOptions & options = InitOptions(),
  SignalHandlerOptions signal_handler_options = SignalHandlerOptions::All);
std::vector<std::string> init_and_remove_ros_arguments(
  int argc, char const * const * argv, const InitOptions & options = InitOptions());
std::vector<std::string> remove_ros_arguments(int argc, char const * const * argv);
bool ok(Context::SharedPtr context = nullptr);
bool shutdown(Context::SharedPtr context = nullptr, const std::string & reason = "user called rclcpp::shutdown()");
void on_shutdown(std::function<void()> callback, Context::SharedPtr context = nullptr);
bool sleep_for(const std::chrono::nanoseconds & length, Context::SharedPtr context = nullptr);
bool install_signal_handlers(SignalHandlerOptions options = SignalHandlerOptions::All);
bool uninstall_signal_handlers();
bool signal_handlers_installed();
}  // namespace rclcpp
#endif
