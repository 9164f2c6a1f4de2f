// The life between init() and shutdown().
#ifndef RCLCPP__CONTEXT_HPP_
#define RCLCPP__CONTEXT_HPP_

#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "rclcpp/macros.hpp"

namespace rclcpp
{
/// Options of init().
class InitOptions
{
public:
  bool shutdown_on_signal = true;
  InitOptions & auto_initialize_logging(bool) {return *this;}
  InitOptions & set_domain_id(std::size_t domain) {domain_ = static_cast<std::int64_t>(domain); return *this;}
  std::int64_t domain() const {return domain_;}

private:
  std::int64_t domain_ = -1;
};

enum class SignalHandlerOptions {All, SigInt, SigTerm, None};

using OnShutdownCallbackHandle = std::shared_ptr<void>;
using PreShutdownCallbackHandle = std::shared_ptr<void>;

/// Scope of one init() and shutdown(). A process has one: contexts::get_global_default_context().
class Context : public std::enable_shared_from_this<Context>
{
public:
  RCLCPP_SMART_PTR_DEFINITIONS(Context)
  void init(int argc, char const * const * argv, const InitOptions & options = InitOptions());
  bool is_valid() const;
  bool shutdown(const std::string & reason);
  std::string shutdown_reason() const;
  std::size_t get_domain_id() const;
  void on_shutdown(std::function<void()> callback);
  OnShutdownCallbackHandle add_on_shutdown_callback(std::function<void()> callback);
  /// Called before ok() becomes false.
  PreShutdownCallbackHandle add_pre_shutdown_callback(std::function<void()> callback);
  /// Wait until shut down, or for a time; false when shut down.
  bool sleep_for(const std::chrono::nanoseconds & length);

  // The executors' side: woken at shutdown while `owner` lives.
  void wake_at_shutdown(const std::weak_ptr<void> & owner, std::function<void()> wake);

private:
  mutable std::mutex mutex_;
  std::string reason_;
  std::vector<std::function<void()>> callbacks_;
  std::vector<std::function<void()>> pre_callbacks_;
  std::vector<std::pair<std::weak_ptr<void>, std::function<void()>>> wakes_;
};

namespace contexts
{
using DefaultContext = Context;
Context::SharedPtr get_global_default_context();
}  // namespace contexts
}  // namespace rclcpp
#endif
