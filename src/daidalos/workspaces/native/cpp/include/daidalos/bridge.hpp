// Calls into the Python part of Daidalos, which holds the session with the graph.
#ifndef DAIDALOS__BRIDGE_HPP_
#define DAIDALOS__BRIDGE_HPP_

#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

namespace daidalos
{
struct Value;
using List = std::vector<Value>;
using Bytes = std::string;
/// Bytes, as opposed to text.
struct Blob
{
  Bytes data;
};
/// A Python object, released with Python's lock held.
using Object = std::shared_ptr<void>;
/// Function that Python may call. Python's lock is free while it runs.
using Callback = std::shared_ptr<std::function<Value(List)>>;

struct Value : std::variant<std::monostate, bool, std::int64_t, double, std::string, Blob, List, Object, Callback>
{
  using variant::variant;
  Value(int value) : variant(static_cast<std::int64_t>(value)) {}  // NOLINT
  Value(const char * text) : variant(std::string(text)) {}  // NOLINT

  std::int64_t integer() const {return std::get<std::int64_t>(*this);}
  bool boolean() const {return std::get<bool>(*this);}
  const std::string & text() const {return std::get<std::string>(*this);}
  const Bytes & bytes() const {return std::get<Blob>(*this).data;}
  const List & list() const {return std::get<List>(*this);}
  const Object & object() const {return std::get<Object>(*this);}
  bool none() const {return index() == 0;}
};

/// Exception of Python, with the name of its class.
struct PythonError : std::runtime_error
{
  PythonError(std::string type_name, const std::string & message)
  : std::runtime_error(message), type(std::move(type_name)) {}
  std::string type;
};

Callback callback(std::function<Value(List)> function);
/// The module daidalos.native.door; starts Python when first called.
Object door();
/// Call a method of an object, or a function of a module.
Value call(const Object & object, const char * method, const List & arguments = {});
/// Call a method with one bytes object, without making a Value of it.
void send(const Object & bound_method, const Bytes & data);
/// Return an attribute as an object.
Object attribute(const Object & object, const char * name);
}  // namespace daidalos

#endif
