// Text of messages as YAML.
#ifndef DAIDALOS__YAML_HPP_
#define DAIDALOS__YAML_HPP_

#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

namespace daidalos
{
/// Visitor of a message's fields that writes YAML in block style.
class YamlWriter
{
public:
  explicit YamlWriter(std::ostringstream & out, int indent = 0) : out_(out), indent_(indent) {}

  template<typename T>
  void operator()(const char * name, const T & value)
  {
    out_ << std::string(indent_, ' ') << name << ':';
    write(value);
  }

private:
  template<typename T>
  void write(const T & value)
  {
    if constexpr (std::is_same<T, bool>::value) {
      out_ << (value ? " true\n" : " false\n");
    } else if constexpr (std::is_arithmetic<T>::value) {
      out_ << ' ' << +value << '\n';
    } else if constexpr (std::is_same<T, std::string>::value || std::is_same<T, std::u16string>::value) {
      text(value);
    } else if constexpr (is_list<T>::value) {
      list(value);
    } else {
      out_ << '\n';
      T::_visit(value, YamlWriter(out_, indent_ + 2));
    }
  }
  template<typename Text>
  void text(const Text & value)
  {
    out_ << " \"";
    for (auto c : value) {
      const char narrow = c < 128 || sizeof(c) == 1 ? static_cast<char>(c) : '?';
      out_ << (narrow == '"' || narrow == '\\' ? "\\" : "") << (c == '\n' ? std::string("\\n") : std::string(1, narrow));
    }
    out_ << "\"\n";
  }
  template<typename T>
  void list(const T & values)
  {
    if (values.size() == 0) {
      out_ << " []\n";
      return;
    }
    out_ << '\n';
    for (typename T::const_reference value : values) {
      out_ << std::string(indent_, ' ') << '-';
      YamlWriter(out_, indent_ + 2).write(static_cast<const typename T::value_type &>(value));
    }
  }
  template<typename T, typename = void>
  struct is_list : std::false_type {};
  template<typename T>
  struct is_list<T, std::void_t<typename T::const_reference>> : std::true_type {};

  std::ostringstream & out_;
  int indent_;
};

template<typename T>
std::string to_yaml(const T & message)
{
  std::ostringstream out;
  T::_visit(message, YamlWriter(out));
  return out.str();
}
}  // namespace daidalos

#endif
