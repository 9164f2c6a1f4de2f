// Publishers, subscriptions, services and clients: bytes to and from the Python side.
#include <algorithm>
#include <thread>

#include "rclcpp/client.hpp"
#include "rclcpp/logging.hpp"
#include "rclcpp/publisher.hpp"
#include "rclcpp/service.hpp"
#include "rclcpp/subscription.hpp"
#include "rclcpp/utilities.hpp"

namespace rclcpp
{
namespace
{
using daidalos::List;
using daidalos::Value;

Value qos_value(const QoS & qos)
{
  const auto & profile = qos.get_rmw_qos_profile();
  const auto ns = [](rmw_time_t time) {return Duration::from_rmw_time(time).nanoseconds();};
  return List{
    static_cast<int>(profile.history), static_cast<std::int64_t>(profile.depth),
    static_cast<int>(profile.reliability), static_cast<int>(profile.durability), ns(profile.deadline),
    ns(profile.lifespan), static_cast<int>(profile.liveliness), ns(profile.liveliness_lease_duration)};
}

Value wake(const std::weak_ptr<daidalos::Entity> & entity)
{
  return daidalos::callback([entity](List) {
             if (const auto held = entity.lock()) {
               held->notify();
             }
             return Value();
           });
}

void close(const daidalos::Object & endpoint)
{
  if (endpoint) {
    try {
      daidalos::call(endpoint, "close");
    } catch (const daidalos::PythonError &) {  // the graph is left at the end of the process anyway
    }
  }
}

std::string name_of(const daidalos::Object & endpoint) {return daidalos::call(endpoint, "get_name").text();}
}  // namespace

PublisherBase::PublisherBase(
  const daidalos::NodeCore & node, const char * type, const std::string & topic, const QoS & qos)
: publisher_(node.call("create_publisher", {type, topic, qos_value(qos)}).object()),
  publish_(daidalos::attribute(publisher_, "publish")), topic_(name_of(publisher_)), qos_(qos)
{
}

PublisherBase::~PublisherBase() {close(publisher_);}

void PublisherBase::send(const daidalos::Bytes & data) const
{
  try {
    if (rclcpp::ok()) {
      daidalos::send(publish_, data);
    }
  } catch (const daidalos::PythonError & error) {
    if (rclcpp::ok()) {  // after shutdown, messages reach nobody
      daidalos::rethrow(error);
    }
  }
}

std::size_t PublisherBase::get_subscription_count() const
{
  return static_cast<std::size_t>(daidalos::call(publisher_, "count").integer());
}

bool PublisherBase::assert_liveliness() const
{
  daidalos::call(publisher_, "assert_liveliness");
  return true;
}

bool PublisherBase::wait_for_acks(std::int64_t timeout_ns) const
{
  return daidalos::call(publisher_, "wait_for_acks", {timeout_ns}).boolean();
}

SubscriptionBase::SubscriptionBase(
  const char * type, const std::string & topic, const QoS & qos, daidalos::MessageHandler handler)
: type_(type), topic_(topic), qos_(qos), handler_(std::move(handler))
{
}

SubscriptionBase::~SubscriptionBase() {close(subscription_);}

void SubscriptionBase::open(const daidalos::NodeCore & node, const CallbackGroup::SharedPtr & group)
{
  join(group);
  subscription_ = node.call(
    "create_subscription", {type_, topic_, qos_value(qos_), wake(weak_from_this())}).object();
  topic_ = name_of(subscription_);
  notify();  // a message may have come before there was an object to take it from
}

std::size_t SubscriptionBase::get_publisher_count() const
{
  return static_cast<std::size_t>(daidalos::call(subscription_, "count").integer());
}

bool SubscriptionBase::take_bytes(daidalos::Bytes & data, MessageInfo & info, bool & more)
{
  std::lock_guard<std::mutex> lock(mutex_);
  if (samples_.empty() && subscription_) {
    Value taken = daidalos::call(subscription_, "take");
    for (auto & item : std::get<List>(taken)) {
      auto & fields = std::get<List>(item);
      Sample sample;
      sample.data = std::move(std::get<daidalos::Blob>(fields.at(0)).data);
      auto & known = sample.info.get_rmw_message_info();
      known.source_timestamp = fields.at(1).integer();
      known.received_timestamp = fields.at(2).integer();
      known.publication_sequence_number = static_cast<std::uint64_t>(fields.at(3).integer());
      const auto & gid = fields.at(4).bytes();
      std::copy_n(gid.begin(), std::min<std::size_t>(gid.size(), 16), known.publisher_gid.data);
      samples_.push_back(std::move(sample));
    }
  }
  if (samples_.empty()) {
    more = false;
    return false;
  }
  data = std::move(samples_.front().data);
  info = samples_.front().info;
  samples_.pop_front();
  // Only a take that finds nothing ends it: a wake that came during an earlier take is spent by then.
  more = true;
  return true;
}

bool SubscriptionBase::run()
{
  daidalos::Bytes data;
  MessageInfo info;
  bool more;
  if (!take_bytes(data, info, more)) {
    return false;
  }
  try {
    handler_(data, info);
  } catch (const daidalos::CdrError & error) {
    RCLCPP_ERROR(get_logger("rclcpp"), "dropped a message on '%s': %s", topic_.c_str(), error.what());
  }
  return more;
}

ServiceBase::~ServiceBase() {close(service_);}

void ServiceBase::open(const daidalos::NodeCore & node, const CallbackGroup::SharedPtr & group)
{
  join(group);
  service_ = node.call("create_service", {type_, name_, qos_value(qos_), wake(weak_from_this())}).object();
  name_ = name_of(service_);
  notify();
}

bool ServiceBase::run()
{
  const auto taken = daidalos::call(service_, "take");
  if (taken.none()) {
    return false;
  }
  const auto & fields = taken.list();
  auto header = std::make_shared<rmw_request_id_t>();
  const auto & client = fields.at(1).bytes();
  std::copy_n(client.begin(), std::min<std::size_t>(client.size(), 16), header->writer_guid);
  header->sequence_number = fields.at(2).integer();
  try {
    handle(header, fields.at(0).bytes());
  } catch (const daidalos::CdrError & error) {
    RCLCPP_ERROR(get_logger("rclcpp"), "dropped a request to '%s': %s", name_.c_str(), error.what());
  }
  return fields.at(3).boolean();
}

void ServiceBase::answer(const rmw_request_id_t & header, const daidalos::Bytes & response)
{
  const daidalos::Bytes client(reinterpret_cast<const char *>(header.writer_guid), 16);
  try {
    daidalos::call(service_, "reply", {daidalos::Blob{client}, header.sequence_number, daidalos::Blob{response}});
  } catch (const daidalos::PythonError & error) {
    daidalos::rethrow(error);
  }
}

ClientBase::~ClientBase() {close(client_);}

void ClientBase::open(const daidalos::NodeCore & node, const CallbackGroup::SharedPtr & group)
{
  join(group);
  client_ = node.call("create_client", {type_, name_, qos_value(qos_), wake(weak_from_this())}).object();
  name_ = name_of(client_);
}

bool ClientBase::service_is_ready() const {return daidalos::call(client_, "ready").boolean();}

bool ClientBase::wait_for_server(std::chrono::nanoseconds timeout)
{
  const auto begin = std::chrono::steady_clock::now();
  while (!service_is_ready()) {
    if (timeout.count() >= 0 && std::chrono::steady_clock::now() - begin >= timeout) {
      return false;
    }
    // Shutdown ends the wait; the graph itself is asked every 10 ms.
    const auto left = timeout.count() < 0 ? timeout : timeout - (std::chrono::steady_clock::now() - begin);
    const std::chrono::nanoseconds step = std::chrono::milliseconds(10);
    if (!rclcpp::sleep_for(timeout.count() < 0 ? step : std::min<std::chrono::nanoseconds>(step, left))) {
      return false;
    }
  }
  return true;
}

std::int64_t ClientBase::send(const daidalos::Bytes & request)
{
  try {
    return daidalos::call(client_, "send", {daidalos::Blob{request}}).integer();
  } catch (const daidalos::PythonError & error) {
    daidalos::rethrow(error);
  }
}

bool ClientBase::run()
{
  const auto taken = daidalos::call(client_, "take");
  if (taken.none()) {
    return false;
  }
  const auto & fields = taken.list();
  try {
    handle(fields.at(1).integer(), fields.at(0).bytes());
  } catch (const daidalos::CdrError & error) {
    RCLCPP_ERROR(get_logger("rclcpp"), "dropped a response of '%s': %s", name_.c_str(), error.what());
  }
  return fields.at(2).boolean();
}
}  // namespace rclcpp
