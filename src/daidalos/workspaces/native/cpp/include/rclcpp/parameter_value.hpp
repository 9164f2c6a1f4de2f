// Values of parameters.
#ifndef RCLCPP__PARAMETER_VALUE_HPP_
#define RCLCPP__PARAMETER_VALUE_HPP_

#include <string>
#include <type_traits>
#include <vector>

#include "rcl_interfaces/msg/parameter_type.hpp"
#include "rcl_interfaces/msg/parameter_value.hpp"
#include "rclcpp/exceptions.hpp"

namespace rclcpp
{
enum ParameterType : std::uint8_t
{
  PARAMETER_NOT_SET, PARAMETER_BOOL, PARAMETER_INTEGER, PARAMETER_DOUBLE, PARAMETER_STRING,
  PARAMETER_BYTE_ARRAY, PARAMETER_BOOL_ARRAY, PARAMETER_INTEGER_ARRAY, PARAMETER_DOUBLE_ARRAY,
  PARAMETER_STRING_ARRAY
};
std::string to_string(ParameterType type);
std::ostream & operator<<(std::ostream & out, ParameterType type);

/// Value of one of the types of parameters.
class ParameterValue
{
public:
  ParameterValue() = default;
  explicit ParameterValue(const rcl_interfaces::msg::ParameterValue & value) : value_(value) {}
  explicit ParameterValue(bool v) {set(PARAMETER_BOOL); value_.bool_value = v;}
  template<typename T, std::enable_if_t<std::is_integral<T>::value && !std::is_same<T, bool>::value, int> = 0>
  explicit ParameterValue(T v) {set(PARAMETER_INTEGER); value_.integer_value = static_cast<std::int64_t>(v);}
  template<typename T, std::enable_if_t<std::is_floating_point<T>::value, int> = 0>
  explicit ParameterValue(T v) {set(PARAMETER_DOUBLE); value_.double_value = v;}
  explicit ParameterValue(const std::string & v) {set(PARAMETER_STRING); value_.string_value = v;}
  explicit ParameterValue(const char * v) : ParameterValue(std::string(v)) {}
  explicit ParameterValue(const std::vector<std::uint8_t> & v)
  {
    set(PARAMETER_BYTE_ARRAY);
    value_.byte_array_value = v;
  }
  explicit ParameterValue(const std::vector<bool> & v) {set(PARAMETER_BOOL_ARRAY); value_.bool_array_value = v;}
  explicit ParameterValue(const std::vector<int> & v) {set(PARAMETER_INTEGER_ARRAY); copy(v, value_.integer_array_value);}
  explicit ParameterValue(const std::vector<std::int64_t> & v)
  {
    set(PARAMETER_INTEGER_ARRAY);
    value_.integer_array_value = v;
  }
  explicit ParameterValue(const std::vector<float> & v) {set(PARAMETER_DOUBLE_ARRAY); copy(v, value_.double_array_value);}
  explicit ParameterValue(const std::vector<double> & v) {set(PARAMETER_DOUBLE_ARRAY); value_.double_array_value = v;}
  explicit ParameterValue(const std::vector<std::string> & v)
  {
    set(PARAMETER_STRING_ARRAY);
    value_.string_array_value = v;
  }

  ParameterType get_type() const {return static_cast<ParameterType>(value_.type);}
  const rcl_interfaces::msg::ParameterValue & to_value_msg() const {return value_;}
  bool operator==(const ParameterValue & other) const {return value_ == other.value_;}
  bool operator!=(const ParameterValue & other) const {return value_ != other.value_;}

  /// The value as a C++ type; throws ParameterTypeException when it has another.
  template<typename T>
  std::decay_t<T> get() const
  {
    using V = std::decay_t<T>;
    if constexpr (std::is_same<V, bool>::value) {
      return expect(PARAMETER_BOOL).bool_value;
    } else if constexpr (std::is_integral<V>::value) {
      return static_cast<V>(expect(PARAMETER_INTEGER).integer_value);
    } else if constexpr (std::is_floating_point<V>::value) {
      return static_cast<V>(expect(PARAMETER_DOUBLE).double_value);
    } else if constexpr (std::is_same<V, std::string>::value) {
      return expect(PARAMETER_STRING).string_value;
    } else if constexpr (std::is_same<V, std::vector<std::uint8_t>>::value) {
      return expect(PARAMETER_BYTE_ARRAY).byte_array_value;
    } else if constexpr (std::is_same<V, std::vector<bool>>::value) {
      return expect(PARAMETER_BOOL_ARRAY).bool_array_value;
    } else if constexpr (std::is_same<V, std::vector<std::string>>::value) {
      return expect(PARAMETER_STRING_ARRAY).string_array_value;
    } else if constexpr (std::is_same<V, ParameterValue>::value) {
      return *this;
    } else if constexpr (std::is_integral<typename V::value_type>::value) {
      const auto & values = expect(PARAMETER_INTEGER_ARRAY).integer_array_value;
      return V(values.begin(), values.end());
    } else {
      const auto & values = expect(PARAMETER_DOUBLE_ARRAY).double_array_value;
      return V(values.begin(), values.end());
    }
  }
  template<ParameterType type>
  auto get() const
  {
    if constexpr (type == PARAMETER_BOOL) {
      return get<bool>();
    } else if constexpr (type == PARAMETER_INTEGER) {
      return get<std::int64_t>();
    } else if constexpr (type == PARAMETER_DOUBLE) {
      return get<double>();
    } else if constexpr (type == PARAMETER_STRING) {
      return get<std::string>();
    } else if constexpr (type == PARAMETER_BYTE_ARRAY) {
      return get<std::vector<std::uint8_t>>();
    } else if constexpr (type == PARAMETER_BOOL_ARRAY) {
      return get<std::vector<bool>>();
    } else if constexpr (type == PARAMETER_INTEGER_ARRAY) {
      return get<std::vector<std::int64_t>>();
    } else if constexpr (type == PARAMETER_DOUBLE_ARRAY) {
      return get<std::vector<double>>();
    } else {
      return get<std::vector<std::string>>();
    }
  }

private:
  void set(ParameterType type) {value_.type = type;}
  template<typename From, typename To>
  static void copy(const From & from, To & to) {to.assign(from.begin(), from.end());}
  const rcl_interfaces::msg::ParameterValue & expect(ParameterType type) const
  {
    if (get_type() != type) {
      throw ParameterTypeException("expected [" + to_string(type) + "] got [" + to_string(get_type()) + "]");
    }
    return value_;
  }

  rcl_interfaces::msg::ParameterValue value_;
};
std::string to_string(const ParameterValue & value);
}  // namespace rclcpp
#endif
