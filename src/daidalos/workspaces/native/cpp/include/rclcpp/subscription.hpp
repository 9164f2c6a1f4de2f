// Subscriptions.
#ifndef RCLCPP__SUBSCRIPTION_HPP_
#define RCLCPP__SUBSCRIPTION_HPP_

#include <deque>
#include <memory>
#include <mutex>
#include <string>

#include "daidalos/node_core.hpp"
#include "rclcpp/any_subscription_callback.hpp"

namespace rclcpp
{
struct SubscriptionOptionsBase
{
  CallbackGroup::SharedPtr callback_group;
  bool ignore_local_publications = false;
};
template<typename Allocator>
struct SubscriptionOptionsWithAllocator : SubscriptionOptionsBase
{
};
using SubscriptionOptions = SubscriptionOptionsWithAllocator<std::allocator<void>>;

class SubscriptionBase : public daidalos::Entity
{
public:
  RCLCPP_SMART_PTR_DEFINITIONS(SubscriptionBase)
  SubscriptionBase(
    const char * type, const std::string & topic, const QoS & qos, daidalos::MessageHandler handler);
  ~SubscriptionBase() override;
  /// Join the graph; second step of the construction, which needs a shared pointer.
  void open(const daidalos::NodeCore & node, const CallbackGroup::SharedPtr & group);

  const char * get_topic_name() const {return topic_.c_str();}
  std::size_t get_publisher_count() const;
  const QoS & get_actual_qos() const {return qos_;}
  bool run() override;

protected:
  /// Take the oldest message as bytes; false when there is none.
  bool take_bytes(daidalos::Bytes & data, MessageInfo & info, bool & more);

private:
  struct Sample
  {
    daidalos::Bytes data;
    MessageInfo info;
  };
  const char * type_;
  std::string topic_;
  QoS qos_;
  daidalos::MessageHandler handler_;
  daidalos::Object subscription_;
  std::mutex mutex_;
  std::deque<Sample> samples_;
};

template<typename MessageT, typename Allocator = std::allocator<void>>
class Subscription : public SubscriptionBase
{
  using Adapter = TypeAdapter<MessageT>;

public:
  RCLCPP_SMART_PTR_DEFINITIONS(Subscription)
  using SubscribedType = typename Adapter::custom_type;
  using ROSMessageType = typename Adapter::ros_message_type;
  using MessageUniquePtr = std::unique_ptr<ROSMessageType>;
  template<typename F>
  Subscription(const std::string & topic, const QoS & qos, F && callback)
  : SubscriptionBase(
      ROSMessageType::_MESSAGE_NAME, topic, qos,
      daidalos::message_handler<MessageT, std::decay_t<F>>(std::forward<F>(callback))) {}

  bool take(ROSMessageType & message, MessageInfo & info)
  {
    daidalos::Bytes data;
    bool more;
    if (!take_bytes(data, info, more)) {
      return false;
    }
    daidalos::decode(data, message);
    return true;
  }
};
}  // namespace rclcpp
#endif
