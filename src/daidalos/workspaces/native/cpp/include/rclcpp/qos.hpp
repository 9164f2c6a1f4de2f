// Quality of service.
#ifndef RCLCPP__QOS_HPP_
#define RCLCPP__QOS_HPP_

#include <cstddef>

#include "rclcpp/duration.hpp"

enum rmw_qos_reliability_policy_t
{
  RMW_QOS_POLICY_RELIABILITY_SYSTEM_DEFAULT, RMW_QOS_POLICY_RELIABILITY_RELIABLE,
  RMW_QOS_POLICY_RELIABILITY_BEST_EFFORT, RMW_QOS_POLICY_RELIABILITY_UNKNOWN,
  RMW_QOS_POLICY_RELIABILITY_BEST_AVAILABLE
};
enum rmw_qos_durability_policy_t
{
  RMW_QOS_POLICY_DURABILITY_SYSTEM_DEFAULT, RMW_QOS_POLICY_DURABILITY_TRANSIENT_LOCAL,
  RMW_QOS_POLICY_DURABILITY_VOLATILE, RMW_QOS_POLICY_DURABILITY_UNKNOWN,
  RMW_QOS_POLICY_DURABILITY_BEST_AVAILABLE
};
enum rmw_qos_history_policy_t
{
  RMW_QOS_POLICY_HISTORY_SYSTEM_DEFAULT, RMW_QOS_POLICY_HISTORY_KEEP_LAST,
  RMW_QOS_POLICY_HISTORY_KEEP_ALL, RMW_QOS_POLICY_HISTORY_UNKNOWN
};
enum rmw_qos_liveliness_policy_t
{
  RMW_QOS_POLICY_LIVELINESS_SYSTEM_DEFAULT, RMW_QOS_POLICY_LIVELINESS_AUTOMATIC,
  RMW_QOS_POLICY_LIVELINESS_MANUAL_BY_NODE, RMW_QOS_POLICY_LIVELINESS_MANUAL_BY_TOPIC,
  RMW_QOS_POLICY_LIVELINESS_UNKNOWN, RMW_QOS_POLICY_LIVELINESS_BEST_AVAILABLE
};
struct rmw_qos_profile_t
{
  rmw_qos_history_policy_t history = RMW_QOS_POLICY_HISTORY_KEEP_LAST;
  std::size_t depth = 10;
  rmw_qos_reliability_policy_t reliability = RMW_QOS_POLICY_RELIABILITY_RELIABLE;
  rmw_qos_durability_policy_t durability = RMW_QOS_POLICY_DURABILITY_VOLATILE;
  rmw_time_t deadline = {0, 0};
  rmw_time_t lifespan = {0, 0};
  rmw_qos_liveliness_policy_t liveliness = RMW_QOS_POLICY_LIVELINESS_SYSTEM_DEFAULT;
  rmw_time_t liveliness_lease_duration = {0, 0};
  bool avoid_ros_namespace_conventions = false;
};
inline const rmw_qos_profile_t rmw_qos_profile_default = {};
inline const rmw_qos_profile_t rmw_qos_profile_services_default = {};
inline const rmw_qos_profile_t rmw_qos_profile_sensor_data = {
  RMW_QOS_POLICY_HISTORY_KEEP_LAST, 5, RMW_QOS_POLICY_RELIABILITY_BEST_EFFORT};
inline const rmw_qos_profile_t rmw_qos_profile_parameters = {RMW_QOS_POLICY_HISTORY_KEEP_LAST, 1000};
inline const rmw_qos_profile_t rmw_qos_profile_parameter_events = rmw_qos_profile_parameters;
inline const rmw_qos_profile_t rmw_qos_profile_system_default = {
  RMW_QOS_POLICY_HISTORY_SYSTEM_DEFAULT, 0, RMW_QOS_POLICY_RELIABILITY_SYSTEM_DEFAULT,
  RMW_QOS_POLICY_DURABILITY_SYSTEM_DEFAULT};

namespace rclcpp
{
enum class HistoryPolicy
{
  KeepLast = RMW_QOS_POLICY_HISTORY_KEEP_LAST, KeepAll = RMW_QOS_POLICY_HISTORY_KEEP_ALL,
  SystemDefault = RMW_QOS_POLICY_HISTORY_SYSTEM_DEFAULT, Unknown = RMW_QOS_POLICY_HISTORY_UNKNOWN
};
enum class ReliabilityPolicy
{
  BestEffort = RMW_QOS_POLICY_RELIABILITY_BEST_EFFORT, Reliable = RMW_QOS_POLICY_RELIABILITY_RELIABLE,
  SystemDefault = RMW_QOS_POLICY_RELIABILITY_SYSTEM_DEFAULT,
  BestAvailable = RMW_QOS_POLICY_RELIABILITY_BEST_AVAILABLE, Unknown = RMW_QOS_POLICY_RELIABILITY_UNKNOWN
};
enum class DurabilityPolicy
{
  Volatile = RMW_QOS_POLICY_DURABILITY_VOLATILE, TransientLocal = RMW_QOS_POLICY_DURABILITY_TRANSIENT_LOCAL,
  SystemDefault = RMW_QOS_POLICY_DURABILITY_SYSTEM_DEFAULT,
  BestAvailable = RMW_QOS_POLICY_DURABILITY_BEST_AVAILABLE, Unknown = RMW_QOS_POLICY_DURABILITY_UNKNOWN
};
enum class LivelinessPolicy
{
  Automatic = RMW_QOS_POLICY_LIVELINESS_AUTOMATIC, ManualByTopic = RMW_QOS_POLICY_LIVELINESS_MANUAL_BY_TOPIC,
  SystemDefault = RMW_QOS_POLICY_LIVELINESS_SYSTEM_DEFAULT,
  BestAvailable = RMW_QOS_POLICY_LIVELINESS_BEST_AVAILABLE, Unknown = RMW_QOS_POLICY_LIVELINESS_UNKNOWN
};

struct QoSInitialization
{
  QoSInitialization(rmw_qos_history_policy_t history, std::size_t depth)
  : history_policy(history), depth(depth) {}
  static QoSInitialization from_rmw(const rmw_qos_profile_t & profile) {return {profile.history, profile.depth};}
  rmw_qos_history_policy_t history_policy;
  std::size_t depth;
};
struct KeepAll : QoSInitialization
{
  KeepAll() : QoSInitialization(RMW_QOS_POLICY_HISTORY_KEEP_ALL, 0) {}
};
struct KeepLast : QoSInitialization
{
  explicit KeepLast(std::size_t depth) : QoSInitialization(RMW_QOS_POLICY_HISTORY_KEEP_LAST, depth) {}
};

/// Quality of service profile; the setters return the profile.
class QoS
{
public:
  explicit QoS(const QoSInitialization & init, const rmw_qos_profile_t & profile = rmw_qos_profile_default)
  : profile_(profile)
  {
    profile_.history = init.history_policy;
    profile_.depth = init.depth;
  }
  QoS(std::size_t depth) : QoS(KeepLast(depth)) {}  // NOLINT: numbers are profiles, as upstream

  rmw_qos_profile_t & get_rmw_qos_profile() {return profile_;}
  const rmw_qos_profile_t & get_rmw_qos_profile() const {return profile_;}

  QoS & history(HistoryPolicy value) {return history(static_cast<rmw_qos_history_policy_t>(value));}
  QoS & history(rmw_qos_history_policy_t value) {profile_.history = value; return *this;}
  QoS & keep_last(std::size_t depth)
  {
    profile_.depth = depth;
    return history(RMW_QOS_POLICY_HISTORY_KEEP_LAST);
  }
  QoS & keep_all() {profile_.depth = 0; return history(RMW_QOS_POLICY_HISTORY_KEEP_ALL);}
  QoS & reliability(ReliabilityPolicy value) {return reliability(static_cast<rmw_qos_reliability_policy_t>(value));}
  QoS & reliability(rmw_qos_reliability_policy_t value) {profile_.reliability = value; return *this;}
  QoS & reliable() {return reliability(ReliabilityPolicy::Reliable);}
  QoS & best_effort() {return reliability(ReliabilityPolicy::BestEffort);}
  QoS & reliability_best_available() {return reliability(ReliabilityPolicy::BestAvailable);}
  QoS & durability(DurabilityPolicy value) {return durability(static_cast<rmw_qos_durability_policy_t>(value));}
  QoS & durability(rmw_qos_durability_policy_t value) {profile_.durability = value; return *this;}
  QoS & durability_volatile() {return durability(DurabilityPolicy::Volatile);}
  QoS & transient_local() {return durability(DurabilityPolicy::TransientLocal);}
  QoS & durability_best_available() {return durability(DurabilityPolicy::BestAvailable);}
  QoS & deadline(rmw_time_t value) {profile_.deadline = value; return *this;}
  QoS & deadline(const Duration & value) {return deadline(value.to_rmw_time());}
  QoS & lifespan(rmw_time_t value) {profile_.lifespan = value; return *this;}
  QoS & lifespan(const Duration & value) {return lifespan(value.to_rmw_time());}
  QoS & liveliness(LivelinessPolicy value) {return liveliness(static_cast<rmw_qos_liveliness_policy_t>(value));}
  QoS & liveliness(rmw_qos_liveliness_policy_t value) {profile_.liveliness = value; return *this;}
  QoS & liveliness_lease_duration(rmw_time_t value) {profile_.liveliness_lease_duration = value; return *this;}
  QoS & liveliness_lease_duration(const Duration & value) {return liveliness_lease_duration(value.to_rmw_time());}

  HistoryPolicy history() const {return static_cast<HistoryPolicy>(profile_.history);}
  std::size_t depth() const {return profile_.depth;}
  ReliabilityPolicy reliability() const {return static_cast<ReliabilityPolicy>(profile_.reliability);}
  DurabilityPolicy durability() const {return static_cast<DurabilityPolicy>(profile_.durability);}
  Duration deadline() const {return Duration::from_rmw_time(profile_.deadline);}
  Duration lifespan() const {return Duration::from_rmw_time(profile_.lifespan);}
  LivelinessPolicy liveliness() const {return static_cast<LivelinessPolicy>(profile_.liveliness);}
  Duration liveliness_lease_duration() const {return Duration::from_rmw_time(profile_.liveliness_lease_duration);}

private:
  rmw_qos_profile_t profile_;
};

#define DAIDALOS_QOS(name, rmw_profile) \
  class name : public QoS \
  { \
public: \
    explicit name(const QoSInitialization & init = QoSInitialization::from_rmw(rmw_profile)) \
    : QoS(init, rmw_profile) {} \
  };
DAIDALOS_QOS(SensorDataQoS, rmw_qos_profile_sensor_data)
DAIDALOS_QOS(ParametersQoS, rmw_qos_profile_parameters)
DAIDALOS_QOS(ServicesQoS, rmw_qos_profile_services_default)
DAIDALOS_QOS(ParameterEventsQoS, rmw_qos_profile_parameter_events)
DAIDALOS_QOS(SystemDefaultsQoS, rmw_qos_profile_system_default)
#undef DAIDALOS_QOS

class ClockQoS : public QoS
{
public:
  explicit ClockQoS(const QoSInitialization & init = KeepLast(1)) : QoS(init) {best_effort();}
};
class RosoutQoS : public QoS
{
public:
  explicit RosoutQoS(const QoSInitialization & init = KeepLast(1000)) : QoS(init)
  {
    transient_local().lifespan(Duration(10, 0));
  }
};
}  // namespace rclcpp
#endif
