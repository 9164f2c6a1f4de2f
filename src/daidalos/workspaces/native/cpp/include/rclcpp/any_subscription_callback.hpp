// The forms that a subscription's callback may have.
#ifndef RCLCPP__ANY_SUBSCRIPTION_CALLBACK_HPP_
#define RCLCPP__ANY_SUBSCRIPTION_CALLBACK_HPP_

#include <functional>
#include <memory>
#include <type_traits>
#include <utility>

#include "daidalos/cdr.hpp"
#include "rclcpp/message_info.hpp"
#include "rclcpp/serialized_message.hpp"
#include "rclcpp/type_adapter.hpp"

namespace daidalos
{
using MessageHandler = std::function<void (Bytes &, const rclcpp::MessageInfo &)>;

template<typename F, typename Argument>
constexpr bool takes = std::is_invocable<F &, Argument>::value ||
  std::is_invocable<F &, Argument, const rclcpp::MessageInfo &>::value;

/// Call with the message's info where the callback takes it.
template<typename F, typename Argument>
void give(F & function, Argument && argument, const rclcpp::MessageInfo & info)
{
  if constexpr (std::is_invocable<F &, Argument>::value) {
    (void)info;
    function(std::forward<Argument>(argument));
  } else {
    function(std::forward<Argument>(argument), info);
  }
}

/// Whether a callback takes a type by reference, or as a pointer of any kind.
template<typename F, typename T>
constexpr bool takes_any = takes<F, const T &> || takes<F, std::shared_ptr<const T>> ||
  takes<F, std::shared_ptr<T>> || takes<F, std::unique_ptr<T>>;

/// Call with what `make` fills, in the form that the callback takes.
template<typename T, typename F, typename Make>
void give_made(F & function, Make && make, const rclcpp::MessageInfo & info)
{
  if constexpr (takes<F, const T &>) {
    T message;
    make(message);
    give(function, static_cast<const T &>(message), info);
  } else if constexpr (takes<F, std::shared_ptr<const T>>) {
    auto message = std::make_shared<T>();
    make(*message);
    give(function, std::shared_ptr<const T>(std::move(message)), info);
  } else if constexpr (takes<F, std::shared_ptr<T>>) {
    auto message = std::make_shared<T>();
    make(*message);
    give(function, std::move(message), info);
  } else {
    auto message = std::make_unique<T>();
    make(*message);
    give(function, std::move(message), info);
  }
}

template<typename MessageT, typename F>
MessageHandler message_handler(F callback)
{
  using Adapter = rclcpp::TypeAdapter<MessageT>;
  using Ros = typename Adapter::ros_message_type;
  using Custom = typename Adapter::custom_type;
  using Serialized = rclcpp::SerializedMessage;
  if constexpr (takes_any<F, Ros>) {
    return [callback](Bytes & data, const rclcpp::MessageInfo & info) mutable {
             give_made<Ros>(callback, [&](Ros & message) {decode(data, message);}, info);
           };
  } else if constexpr (takes_any<F, Custom>) {
    return [callback](Bytes & data, const rclcpp::MessageInfo & info) mutable {
             give_made<Custom>(callback, [&](Custom & custom) {
                 Ros message;
                 decode(data, message);
                 Adapter::convert_to_custom(message, custom);
               }, info);
           };
  } else {
    static_assert(takes_any<F, Serialized>,
      "the callback of a subscription takes the message as 'const M &', 'M::SharedPtr', 'M::ConstSharedPtr' or "
      "'M::UniquePtr', or a SerializedMessage likewise, and as a second argument a 'const rclcpp::MessageInfo &'");
    return [callback](Bytes & data, const rclcpp::MessageInfo & info) mutable {
             give_made<Serialized>(callback, [&](Serialized & message) {message.bytes() = std::move(data);}, info);
           };
  }
}
}  // namespace daidalos
#endif
