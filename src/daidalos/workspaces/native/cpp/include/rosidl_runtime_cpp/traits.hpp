// Facts about generated messages and services, for templates.
#ifndef ROSIDL_RUNTIME_CPP__TRAITS_HPP_
#define ROSIDL_RUNTIME_CPP__TRAITS_HPP_

#include <string>
#include <type_traits>

#include "daidalos/yaml.hpp"

namespace rosidl_generator_traits
{
template<typename T, typename = void>
struct is_message : std::false_type {};
template<typename T>
struct is_message<T, std::void_t<decltype(T::_MESSAGE_NAME)>> : std::true_type {};

template<typename T, typename = void>
struct is_service : std::false_type {};
template<typename T>
struct is_service<T, std::void_t<decltype(T::_SERVICE_NAME)>> : std::true_type {};

template<typename T, typename = void>
struct is_action : std::false_type {};
template<typename T>
struct is_action<T, std::void_t<decltype(T::_ACTION_NAME)>> : std::true_type {};

/// Full name of an interface, such as "std_msgs/msg/String".
template<typename T>
inline const char * name()
{
  if constexpr (is_service<T>::value) {
    return T::_SERVICE_NAME;
  } else if constexpr (is_action<T>::value) {
    return T::_ACTION_NAME;
  } else {
    return T::_MESSAGE_NAME;
  }
}

/// Name of the C++ type, such as "std_msgs::msg::String".
template<typename T>
inline const char * data_type()
{
  static const std::string text = [] {
      std::string result;
      for (const char * at = name<T>(); *at; ++at) {
        result += *at == '/' ? std::string("::") : std::string(1, *at);
      }
      return result;
    }();
  return text.c_str();
}

/// Text of a message as block style YAML.
template<typename T, typename = std::enable_if_t<is_message<T>::value>>
inline std::string to_yaml(const T & message)
{
  return daidalos::to_yaml(message);
}
}  // namespace rosidl_generator_traits

#endif
