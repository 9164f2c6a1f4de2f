// Publishers.
#ifndef RCLCPP__PUBLISHER_HPP_
#define RCLCPP__PUBLISHER_HPP_

#include <chrono>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "daidalos/cdr.hpp"
#include "daidalos/node_core.hpp"
#include "rclcpp/message_info.hpp"
#include "rclcpp/serialized_message.hpp"
#include "rclcpp/type_adapter.hpp"


enum rmw_unique_network_flow_endpoints_requirement_t
{
  RMW_UNIQUE_NETWORK_FLOW_ENDPOINTS_NOT_REQUIRED, RMW_UNIQUE_NETWORK_FLOW_ENDPOINTS_STRICTLY_REQUIRED,
  RMW_UNIQUE_NETWORK_FLOW_ENDPOINTS_OPTIONALLY_REQUIRED
};

namespace rclcpp
{
struct PublisherOptionsBase
{
  CallbackGroup::SharedPtr callback_group;
  rmw_unique_network_flow_endpoints_requirement_t require_unique_network_flow_endpoints =
    RMW_UNIQUE_NETWORK_FLOW_ENDPOINTS_NOT_REQUIRED;
};

/// Address that messages are sent from; no middleware of ours tells it.
struct NetworkFlowEndpoint
{
};
inline std::ostream & operator<<(std::ostream & out, const NetworkFlowEndpoint &) {return out;}
template<typename Allocator>
struct PublisherOptionsWithAllocator : PublisherOptionsBase
{
};
using PublisherOptions = PublisherOptionsWithAllocator<std::allocator<void>>;

class PublisherBase
{
public:
  RCLCPP_SMART_PTR_DEFINITIONS(PublisherBase)
  PublisherBase(const daidalos::NodeCore & node, const char * type, const std::string & topic, const QoS & qos);
  virtual ~PublisherBase();
  const char * get_topic_name() const {return topic_.c_str();}
  std::size_t get_subscription_count() const;
  std::size_t get_intra_process_subscription_count() const {return 0;}
  const QoS & get_actual_qos() const {return qos_;}
  bool assert_liveliness() const;
  /// Throws: the middlewares do not tell, as upstream's zenoh and Cyclone do not either.
  std::vector<NetworkFlowEndpoint> get_network_flow_endpoints() const
  {
    throw exceptions::RCLError("the middleware does not tell network flow endpoints");
  }
  bool can_loan_messages() const {return false;}
  template<typename Rep = std::int64_t, typename Period = std::milli>
  bool wait_for_all_acked(
    std::chrono::duration<Rep, Period> timeout = std::chrono::duration<Rep, Period>(-1)) const
  {
    return wait_for_acks(std::chrono::duration_cast<std::chrono::nanoseconds>(timeout).count());
  }

protected:
  void send(const daidalos::Bytes & data) const;
  bool wait_for_acks(std::int64_t timeout_ns) const;

private:
  daidalos::Object publisher_;
  daidalos::Object publish_;
  std::string topic_;
  QoS qos_;
};

/// Publisher of messages of a type, or of a type that an adapter turns into one.
template<typename MessageT, typename Allocator = std::allocator<void>>
class Publisher : public PublisherBase
{
  using Adapter = TypeAdapter<MessageT>;

public:
  RCLCPP_SMART_PTR_DEFINITIONS(Publisher)
  using PublishedType = typename Adapter::custom_type;
  using ROSMessageType = typename Adapter::ros_message_type;
  Publisher(const daidalos::NodeCore & node, const std::string & topic, const QoS & qos)
  : PublisherBase(node, ROSMessageType::_MESSAGE_NAME, topic, qos) {}

  void publish(const ROSMessageType & message)
  {
    daidalos::Bytes data;
    daidalos::encode(message, data);
    send(data);
  }
  template<typename T>
  std::enable_if_t<std::is_same<T, PublishedType>::value && !std::is_same<T, ROSMessageType>::value> publish(
    const T & message)
  {
    ROSMessageType converted;
    Adapter::convert_to_ros_message(message, converted);
    publish(converted);
  }
  template<typename T, typename Deleter>
  void publish(std::unique_ptr<T, Deleter> message) {publish(*message);}
  void publish(const SerializedMessage & message) {send(message.bytes());}
};
}  // namespace rclcpp
#endif
