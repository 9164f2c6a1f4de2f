// Options of nodes.
#ifndef RCLCPP__NODE_OPTIONS_HPP_
#define RCLCPP__NODE_OPTIONS_HPP_

#include <string>
#include <vector>

#include "rclcpp/context.hpp"
#include "rclcpp/parameter.hpp"

namespace rclcpp
{
/// Options of a node; the setters return the options.
class NodeOptions
{
public:
#define DAIDALOS_OPTION(type, name, value) \
  NodeOptions & name(type given) {name ## _ = given; return *this;} \
  type name() const {return name ## _;} \
\
private: \
  type name ## _ = value; \
\
public:
  DAIDALOS_OPTION(bool, use_global_arguments, true)
  DAIDALOS_OPTION(bool, enable_rosout, true)
  DAIDALOS_OPTION(bool, use_intra_process_comms, false)
  DAIDALOS_OPTION(bool, start_parameter_services, true)
  DAIDALOS_OPTION(bool, start_parameter_event_publisher, true)
  DAIDALOS_OPTION(bool, use_clock_thread, true)
  DAIDALOS_OPTION(bool, enable_logger_service, false)
  DAIDALOS_OPTION(bool, allow_undeclared_parameters, false)
  DAIDALOS_OPTION(bool, automatically_declare_parameters_from_overrides, false)
#undef DAIDALOS_OPTION
  NodeOptions & arguments(const std::vector<std::string> & given) {arguments_ = given; return *this;}
  const std::vector<std::string> & arguments() const {return arguments_;}
  NodeOptions & parameter_overrides(const std::vector<Parameter> & given) {overrides_ = given; return *this;}
  const std::vector<Parameter> & parameter_overrides() const {return overrides_;}
  std::vector<Parameter> & parameter_overrides() {return overrides_;}
  template<typename T>
  NodeOptions & append_parameter_override(const std::string & name, const T & value)
  {
    overrides_.emplace_back(name, ParameterValue(value));
    return *this;
  }
  NodeOptions & context(Context::SharedPtr) {return *this;}
  Context::SharedPtr context() const {return contexts::get_global_default_context();}

private:
  std::vector<std::string> arguments_;
  std::vector<Parameter> overrides_;
};
}  // namespace rclcpp
#endif
