// Exceptions.
#ifndef RCLCPP__EXCEPTIONS_HPP_
#define RCLCPP__EXCEPTIONS_HPP_

#include <stdexcept>
#include <string>

namespace rclcpp::exceptions
{
#define DAIDALOS_EXCEPTION(name, base) \
  class name : public base \
  { \
public: \
    explicit name(const std::string & text) : base(text) {} \
  };
DAIDALOS_EXCEPTION(RCLError, std::runtime_error)
DAIDALOS_EXCEPTION(RCLInvalidROSArgsError, RCLError)
DAIDALOS_EXCEPTION(NameValidationError, std::invalid_argument)
DAIDALOS_EXCEPTION(InvalidNodeNameError, NameValidationError)
DAIDALOS_EXCEPTION(InvalidNamespaceError, NameValidationError)
DAIDALOS_EXCEPTION(InvalidTopicNameError, NameValidationError)
DAIDALOS_EXCEPTION(InvalidServiceNameError, NameValidationError)
DAIDALOS_EXCEPTION(InvalidParametersException, std::runtime_error)
DAIDALOS_EXCEPTION(InvalidParameterValueException, std::runtime_error)
DAIDALOS_EXCEPTION(InvalidParameterTypeException, std::runtime_error)
DAIDALOS_EXCEPTION(ParameterAlreadyDeclaredException, std::runtime_error)
DAIDALOS_EXCEPTION(ParameterNotDeclaredException, std::runtime_error)
DAIDALOS_EXCEPTION(ParameterImmutableException, std::runtime_error)
DAIDALOS_EXCEPTION(ParameterUninitializedException, std::runtime_error)
#undef DAIDALOS_EXCEPTION
}  // namespace rclcpp::exceptions
namespace rclcpp
{
/// A value was asked for as a type that it does not have.
class ParameterTypeException : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};
}  // namespace rclcpp
#endif
