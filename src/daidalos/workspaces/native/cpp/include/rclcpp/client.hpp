// Service clients.
#ifndef RCLCPP__CLIENT_HPP_
#define RCLCPP__CLIENT_HPP_

#include <chrono>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "daidalos/cdr.hpp"
#include "daidalos/node_core.hpp"

namespace rclcpp
{
class ClientBase : public daidalos::Entity
{
public:
  RCLCPP_SMART_PTR_DEFINITIONS(ClientBase)
  ClientBase(const char * type, const std::string & name, const QoS & qos) : type_(type), name_(name), qos_(qos) {}
  ~ClientBase() override;
  void open(const daidalos::NodeCore & node, const CallbackGroup::SharedPtr & group);
  const char * get_service_name() const {return name_.c_str();}
  bool service_is_ready() const;
  template<typename Rep = std::int64_t, typename Period = std::milli>
  bool wait_for_service(std::chrono::duration<Rep, Period> timeout = std::chrono::duration<Rep, Period>(-1))
  {
    return wait_for_server(std::chrono::duration_cast<std::chrono::nanoseconds>(timeout));
  }
  bool run() override;

protected:
  std::int64_t send(const daidalos::Bytes & request);
  virtual void handle(std::int64_t number, const daidalos::Bytes & response) = 0;

private:
  bool wait_for_server(std::chrono::nanoseconds timeout);
  const char * type_;
  std::string name_;
  QoS qos_;
  daidalos::Object client_;
};

namespace detail
{
template<typename FutureT>
struct FutureAndRequestId
{
  FutureAndRequestId(FutureT given, std::int64_t id) : future(std::move(given)), request_id(id) {}
  operator FutureT &() {return future;}  // NOLINT
  auto get() {return future.get();}
  bool valid() const noexcept {return future.valid();}
  void wait() const {future.wait();}
  template<class Rep, class Period>
  std::future_status wait_for(const std::chrono::duration<Rep, Period> & timeout) const
  {
    return future.wait_for(timeout);
  }
  template<class Clock, class Duration>
  std::future_status wait_until(const std::chrono::time_point<Clock, Duration> & time) const
  {
    return future.wait_until(time);
  }
  FutureT future;
  std::int64_t request_id;
};
}  // namespace detail

template<typename ServiceT>
class Client : public ClientBase
{
public:
  RCLCPP_SMART_PTR_DEFINITIONS(Client)
  using Request = typename ServiceT::Request;
  using Response = typename ServiceT::Response;
  using SharedRequest = std::shared_ptr<Request>;
  using SharedResponse = std::shared_ptr<Response>;
  using Promise = std::promise<SharedResponse>;
  using Future = std::future<SharedResponse>;
  using SharedFuture = std::shared_future<SharedResponse>;
  using SharedFutureWithRequest = std::shared_future<std::pair<SharedRequest, SharedResponse>>;
  using CallbackType = std::function<void (SharedFuture)>;
  struct FutureAndRequestId : detail::FutureAndRequestId<Future>
  {
    using detail::FutureAndRequestId<Future>::FutureAndRequestId;
    SharedFuture share() noexcept {return this->future.share();}
  };
  using SharedFutureAndRequestId = detail::FutureAndRequestId<SharedFuture>;
  using SharedFutureWithRequestAndRequestId = detail::FutureAndRequestId<SharedFutureWithRequest>;

  Client(const std::string & name, const QoS & qos) : ClientBase(ServiceT::_SERVICE_NAME, name, qos) {}

  FutureAndRequestId async_send_request(SharedRequest request)
  {
    auto promise = std::make_shared<Promise>();
    auto future = promise->get_future();
    const auto id = submit(*request, [promise](SharedResponse response) {promise->set_value(std::move(response));});
    return FutureAndRequestId(std::move(future), id);
  }
  template<typename F, std::enable_if_t<std::is_invocable<F &, SharedFuture>::value, int> = 0>
  SharedFutureAndRequestId async_send_request(SharedRequest request, F && callback)
  {
    auto promise = std::make_shared<Promise>();
    SharedFuture future = promise->get_future().share();
    std::decay_t<F> function(std::forward<F>(callback));
    const auto id = submit(*request, [promise, future, function](SharedResponse response) mutable {
          promise->set_value(std::move(response));
          function(future);
        });
    return SharedFutureAndRequestId(future, id);
  }
  template<typename F, std::enable_if_t<!std::is_invocable<F &, SharedFuture>::value &&
    std::is_invocable<F &, SharedFutureWithRequest>::value, int> = 0>
  SharedFutureWithRequestAndRequestId async_send_request(SharedRequest request, F && callback)
  {
    auto promise = std::make_shared<std::promise<std::pair<SharedRequest, SharedResponse>>>();
    SharedFutureWithRequest future = promise->get_future().share();
    std::decay_t<F> function(std::forward<F>(callback));
    const auto id = submit(*request, [promise, future, function, request](SharedResponse response) mutable {
          promise->set_value({request, std::move(response)});
          function(future);
        });
    return SharedFutureWithRequestAndRequestId(future, id);
  }
  bool remove_pending_request(std::int64_t id)
  {
    std::lock_guard<std::mutex> lock(mutex_);
    return pending_.erase(id) != 0;
  }
  template<typename FutureT>
  bool remove_pending_request(const FutureT & sent) {return remove_pending_request(sent.request_id);}
  /// Forget the requests sent before a time; their numbers are added to `pruned`.
  template<typename Allocator = std::allocator<std::int64_t>>
  std::size_t prune_requests_older_than(
    std::chrono::time_point<std::chrono::system_clock> time, std::vector<std::int64_t, Allocator> * pruned = nullptr)
  {
    std::lock_guard<std::mutex> lock(mutex_);
    std::size_t count = 0;
    for (auto at = pending_.begin(); at != pending_.end(); ) {
      if (at->second.sent >= time) {
        ++at;
        continue;
      }
      if (pruned) {
        pruned->push_back(at->first);
      }
      at = pending_.erase(at);
      ++count;
    }
    return count;
  }
  std::size_t prune_pending_requests()
  {
    std::lock_guard<std::mutex> lock(mutex_);
    const std::size_t count = pending_.size();
    pending_.clear();
    return count;
  }

private:
  using Finish = std::function<void (SharedResponse)>;
  struct Pending
  {
    Finish finish;
    std::chrono::system_clock::time_point sent;
  };
  std::int64_t submit(const Request & request, Finish finish)
  {
    daidalos::Bytes data;
    daidalos::encode(request, data);
    std::lock_guard<std::mutex> lock(mutex_);  // the response may come before send() returns
    const std::int64_t id = send(data);
    pending_[id] = {std::move(finish), std::chrono::system_clock::now()};
    return id;
  }
  void handle(std::int64_t number, const daidalos::Bytes & data) override
  {
    auto response = std::make_shared<Response>();
    daidalos::decode(data, *response);
    Finish finish;
    {
      std::lock_guard<std::mutex> lock(mutex_);
      auto found = pending_.find(number);
      if (found == pending_.end()) {
        return;
      }
      finish = std::move(found->second.finish);
      pending_.erase(found);
    }
    finish(std::move(response));
  }
  std::mutex mutex_;
  std::map<std::int64_t, Pending> pending_;
};
}  // namespace rclcpp
#endif
