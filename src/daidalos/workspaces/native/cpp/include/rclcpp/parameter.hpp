// Parameters: a name with a value.
#ifndef RCLCPP__PARAMETER_HPP_
#define RCLCPP__PARAMETER_HPP_

#include <utility>

#include "rcl_interfaces/msg/parameter.hpp"
#include "rclcpp/parameter_value.hpp"

namespace rclcpp
{
class Parameter
{
public:
  Parameter() = default;
  explicit Parameter(std::string name) : name_(std::move(name)) {}
  Parameter(std::string name, const ParameterValue & value) : name_(std::move(name)), value_(value) {}
  template<typename T>
  Parameter(std::string name, const T & value) : name_(std::move(name)), value_(value) {}

  static Parameter from_parameter_msg(const rcl_interfaces::msg::Parameter & message)
  {
    return Parameter(message.name, ParameterValue(message.value));
  }
  rcl_interfaces::msg::Parameter to_parameter_msg() const
  {
    rcl_interfaces::msg::Parameter message;
    message.name = name_;
    message.value = value_.to_value_msg();
    return message;
  }

  const std::string & get_name() const {return name_;}
  ParameterType get_type() const {return value_.get_type();}
  std::string get_type_name() const {return to_string(get_type());}
  const ParameterValue & get_parameter_value() const {return value_;}
  rcl_interfaces::msg::ParameterValue get_value_message() const {return value_.to_value_msg();}
  bool operator==(const Parameter & other) const {return name_ == other.name_ && value_ == other.value_;}
  bool operator!=(const Parameter & other) const {return !(*this == other);}

  template<typename T>
  decltype(auto) get_value() const {return named([this] {return value_.get<T>();});}
  template<ParameterType type>
  decltype(auto) get_value() const {return named([this] {return value_.get<type>();});}
  bool as_bool() const {return get_value<bool>();}
  std::int64_t as_int() const {return get_value<std::int64_t>();}
  double as_double() const {return get_value<double>();}
  std::string as_string() const {return get_value<std::string>();}
  std::vector<std::uint8_t> as_byte_array() const {return get_value<std::vector<std::uint8_t>>();}
  std::vector<bool> as_bool_array() const {return get_value<std::vector<bool>>();}
  std::vector<std::int64_t> as_integer_array() const {return get_value<std::vector<std::int64_t>>();}
  std::vector<double> as_double_array() const {return get_value<std::vector<double>>();}
  std::vector<std::string> as_string_array() const {return get_value<std::vector<std::string>>();}
  std::string value_to_string() const {return to_string(value_);}

private:
  template<typename F>
  auto named(F get) const -> decltype(get())
  {
    try {
      return get();
    } catch (const ParameterTypeException & error) {
      throw exceptions::InvalidParameterTypeException(
              "parameter '" + name_ + "' has invalid type: " + error.what());
    }
  }

  std::string name_;
  ParameterValue value_;
};
inline std::ostream & operator<<(std::ostream & out, const Parameter & parameter)
{
  return out << "{\"name\": \"" << parameter.get_name() << "\", \"type\": \"" << parameter.get_type_name() <<
         "\", \"value\": \"" << parameter.value_to_string() << "\"}";
}
}  // namespace rclcpp
#endif
