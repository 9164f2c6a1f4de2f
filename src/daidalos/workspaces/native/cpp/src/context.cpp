#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "daidalos/bridge.hpp"
#include "daidalos/cdr.hpp"
#include "daidalos/node_core.hpp"
#include "rclcpp/exceptions.hpp"
#include "rclcpp/utilities.hpp"

namespace daidalos
{
int & wide_characters()
{
  static int bytes = 2;
  return bytes;
}

void rethrow(const PythonError & error)
{
  const std::string text = error.what();
#define DAIDALOS_AS(python, exception) \
  if (error.type == python) { \
    throw rclcpp::exceptions::exception(text); \
  }
  DAIDALOS_AS("ParameterAlreadyDeclaredException", ParameterAlreadyDeclaredException)
  DAIDALOS_AS("ParameterNotDeclaredException", ParameterNotDeclaredException)
  DAIDALOS_AS("ParameterImmutableException", ParameterImmutableException)
  DAIDALOS_AS("ParameterUninitializedException", ParameterUninitializedException)
  DAIDALOS_AS("InvalidParameterTypeException", InvalidParameterTypeException)
  DAIDALOS_AS("InvalidParameterValueException", InvalidParameterValueException)
  DAIDALOS_AS("InvalidParameterException", InvalidParametersException)
  DAIDALOS_AS("InvalidNodeNameException", InvalidNodeNameError)
  DAIDALOS_AS("InvalidNamespaceException", InvalidNamespaceError)
  DAIDALOS_AS("InvalidTopicNameException", InvalidTopicNameError)
  DAIDALOS_AS("InvalidServiceNameException", InvalidServiceNameError)
#undef DAIDALOS_AS
  throw rclcpp::exceptions::RCLError(text);
}
}  // namespace daidalos

namespace rclcpp
{
namespace
{
/// Number of the interface to daidalos.native.door; it has the same.
constexpr int kInterfaceVersion = 1;
std::atomic<bool> valid{false};
std::condition_variable ended;
std::size_t domain_id = 0;

int signal_pipe[2] = {-1, -1};
struct sigaction old_interrupt, old_terminate;
bool handles_interrupt = false, handles_terminate = false;

extern "C" void on_signal(int number)
{
  const char byte = static_cast<char>(number);
  const auto written = write(signal_pipe[1], &byte, 1);
  (void)written;
}

/// Wait for signals and shut down, outside of their handler.
void watch_signals()
{
  char number;
  while (read(signal_pipe[0], &number, 1) == 1) {
    contexts::get_global_default_context()->shutdown("signal handler");
  }
}

void leave_graph()
{
  try {
    daidalos::call(daidalos::door(), "finish");
  } catch (const daidalos::PythonError &) {  // the process ends anyway
  }
}
}  // namespace

void Context::init(int argc, char const * const * argv, const InitOptions & options)
{
  if (valid) {
    throw std::runtime_error("context is already initialized");
  }
  daidalos::List arguments;
  for (int i = 0; i < argc; ++i) {
    arguments.emplace_back(std::string(argv[i]));
  }
  try {
    const auto found = daidalos::call(
      daidalos::door(), "init", {arguments, options.domain(), kInterfaceVersion}).list();
    daidalos::wide_characters() = static_cast<int>(found.at(0).integer());
    domain_id = static_cast<std::size_t>(found.at(1).integer());
  } catch (const daidalos::PythonError & error) {
    if (error.type == "OutdatedError") {
      fprintf(stderr, "rclcpp: %s\n", error.what());
      std::exit(1);
    }
    throw exceptions::RCLInvalidROSArgsError(error.what());
  }
  static const bool registered = std::atexit(leave_graph) == 0;
  (void)registered;
  valid = true;
}

bool Context::is_valid() const {return valid;}

std::size_t Context::get_domain_id() const {return domain_id;}

std::string Context::shutdown_reason() const
{
  std::lock_guard<std::mutex> lock(mutex_);
  return reason_;
}

bool Context::shutdown(const std::string & reason)
{
  std::vector<std::function<void()>> callbacks, pre_callbacks;
  {
    std::lock_guard<std::mutex> lock(mutex_);
    pre_callbacks.swap(pre_callbacks_);
  }
  for (const auto & callback : pre_callbacks) {
    callback();
  }
  {
    std::lock_guard<std::mutex> lock(mutex_);
    if (!valid.exchange(false)) {
      return false;
    }
    reason_ = reason;
    callbacks.swap(callbacks_);
    for (const auto & [owner, wake] : wakes_) {
      callbacks.push_back(wake);
    }
  }
  ended.notify_all();
  for (const auto & callback : callbacks) {
    callback();
  }
  try {
    daidalos::call(daidalos::door(), "shutdown");
  } catch (const daidalos::PythonError & error) {
    fprintf(stderr, "rclcpp: cannot leave the graph: %s\n", error.what());
  }
  return true;
}

void Context::on_shutdown(std::function<void()> callback)
{
  std::lock_guard<std::mutex> lock(mutex_);
  callbacks_.push_back(std::move(callback));
}

OnShutdownCallbackHandle Context::add_on_shutdown_callback(std::function<void()> callback)
{
  on_shutdown(std::move(callback));
  return std::make_shared<char>();
}

PreShutdownCallbackHandle Context::add_pre_shutdown_callback(std::function<void()> callback)
{
  std::lock_guard<std::mutex> lock(mutex_);
  pre_callbacks_.push_back(std::move(callback));
  return std::make_shared<char>();
}

void Context::wake_at_shutdown(const std::weak_ptr<void> & owner, std::function<void()> wake)
{
  std::lock_guard<std::mutex> lock(mutex_);
  for (auto at = wakes_.begin(); at != wakes_.end(); ) {
    at = at->first.expired() ? wakes_.erase(at) : at + 1;
  }
  wakes_.emplace_back(owner, std::move(wake));
}

bool Context::sleep_for(const std::chrono::nanoseconds & length)
{
  std::unique_lock<std::mutex> lock(mutex_);
  ended.wait_for(lock, length, [] {return !valid;});
  return valid;
}

Context::SharedPtr contexts::get_global_default_context()
{
  // Never destroyed: threads may still ask for it when the process ends.
  static auto * context = new Context::SharedPtr(std::make_shared<Context>());
  return *context;
}

void init(int argc, char const * const * argv, const InitOptions & options, SignalHandlerOptions signals)
{
  contexts::get_global_default_context()->init(argc, argv, options);
  install_signal_handlers(signals);
}

std::vector<std::string> init_and_remove_ros_arguments(
  int argc, char const * const * argv, const InitOptions & options)
{
  init(argc, argv, options);
  return remove_ros_arguments(argc, argv);
}

std::vector<std::string> remove_ros_arguments(int argc, char const * const * argv)
{
  daidalos::List arguments;
  for (int i = 0; i < argc; ++i) {
    arguments.emplace_back(std::string(argv[i]));
  }
  std::vector<std::string> found;
  try {
    const daidalos::Value rest = daidalos::call(daidalos::door(), "without_ros_arguments", {arguments});
    for (const auto & one : rest.list()) {
      found.push_back(one.text());
    }
  } catch (const daidalos::PythonError & error) {
    throw exceptions::RCLInvalidROSArgsError(error.what());
  }
  return found;
}

bool ok(Context::SharedPtr) {return valid;}

bool shutdown(Context::SharedPtr, const std::string & reason)
{
  const bool done = contexts::get_global_default_context()->shutdown(reason);
  uninstall_signal_handlers();
  return done;
}

void on_shutdown(std::function<void()> callback, Context::SharedPtr)
{
  contexts::get_global_default_context()->on_shutdown(std::move(callback));
}

bool sleep_for(const std::chrono::nanoseconds & length, Context::SharedPtr)
{
  return contexts::get_global_default_context()->sleep_for(length);
}

bool install_signal_handlers(SignalHandlerOptions options)
{
  if (signal_pipe[0] < 0) {
    if (pipe(signal_pipe)) {
      throw std::runtime_error("cannot create the pipe of the signal handlers");
    }
    std::thread(watch_signals).detach();
  }
  struct sigaction action = {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  const bool all = options == SignalHandlerOptions::All;
  if ((all || options == SignalHandlerOptions::SigInt) && !handles_interrupt) {
    handles_interrupt = !sigaction(SIGINT, &action, &old_interrupt);
  }
  if ((all || options == SignalHandlerOptions::SigTerm) && !handles_terminate) {
    handles_terminate = !sigaction(SIGTERM, &action, &old_terminate);
  }
  return handles_interrupt || handles_terminate;
}

bool uninstall_signal_handlers()
{
  const bool installed = signal_handlers_installed();
  if (handles_interrupt) {
    sigaction(SIGINT, &old_interrupt, nullptr);
  }
  if (handles_terminate) {
    sigaction(SIGTERM, &old_terminate, nullptr);
  }
  handles_interrupt = handles_terminate = false;
  return installed;
}

bool signal_handlers_installed() {return handles_interrupt || handles_terminate;}
}  // namespace rclcpp
