// Classic CDR (XCDR version 1, little endian) of messages, by a visit of their fields.
#ifndef DAIDALOS__CDR_HPP_
#define DAIDALOS__CDR_HPP_

#include <array>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "rosidl_runtime_cpp/bounded_vector.hpp"

namespace daidalos
{
using Bytes = std::string;

/// Bytes of a character of a wide string in the middleware in use: 2 or 4.
int & wide_characters();

/// Bytes that are not a message of the expected type.
struct CdrError : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

template<typename T>
constexpr bool is_plain = std::is_arithmetic<T>::value && !std::is_same<T, bool>::value;

/// Visitor that appends fields to a buffer. Alignment counts from the byte after the header, at most 8.
class CdrWriter
{
public:
  explicit CdrWriter(Bytes & out) : out_(out) {out_.assign("\0\1\0\0", 4);}

  template<typename T>
  void operator()(const char *, const T & value) {write(value);}

  template<typename T>
  void write(const T & value)
  {
    if constexpr (std::is_same<T, bool>::value) {
      out_.push_back(value ? 1 : 0);
    } else if constexpr (std::is_arithmetic<T>::value) {
      align(sizeof(T));
      append(&value, sizeof(T));
    } else {
      T::_visit(value, *this);
    }
  }
  void write(const std::string & value)
  {
    count(value.size() + 1);
    append(value.c_str(), value.size() + 1);
  }
  void write(const std::u16string & value)
  {
    count(value.size());
    for (char16_t c : value) {
      if (wide_characters() == 2) {
        write(static_cast<std::uint16_t>(c));
      } else {
        write(static_cast<std::uint32_t>(c));
      }
    }
  }
  template<typename T, std::size_t N>
  void write(const std::array<T, N> & values) {elements(values);}
  template<typename T>
  void write(const std::vector<T> & values) {count(values.size()); elements(values);}
  template<typename T, std::size_t N>
  void write(const rosidl_runtime_cpp::BoundedVector<T, N> & values) {count(values.size()); elements(values);}

private:
  template<typename C>
  void elements(const C & values)
  {
    using T = typename C::value_type;
    if constexpr (is_plain<T>) {
      if (values.size() != 0) {
        align(sizeof(T));
        append(values.data(), values.size() * sizeof(T));
      }
    } else {
      for (typename C::const_reference value : values) {
        write(static_cast<const T &>(value));
      }
    }
  }
  void count(std::size_t n) {write(static_cast<std::uint32_t>(n));}
  void align(std::size_t size) {out_.append((0 - (out_.size() - 4)) & (size - 1), '\0');}
  void append(const void * data, std::size_t size) {out_.append(static_cast<const char *>(data), size);}

  Bytes & out_;
};

/// Visitor that sets fields from bytes.
class CdrReader
{
public:
  CdrReader(const char * data, std::size_t size) : data_(data), size_(size)
  {
    if (size < 4) {
      throw CdrError("the message has no header");
    }
    swap_ = data[1] == 0;
    at_ = 4;
  }

  template<typename T>
  void operator()(const char *, T & value) {read(value);}

  template<typename T>
  void read(T & value)
  {
    if constexpr (std::is_same<T, bool>::value) {
      value = *take(1) != 0;
    } else if constexpr (std::is_arithmetic<T>::value) {
      align(sizeof(T));
      std::memcpy(&value, take(sizeof(T)), sizeof(T));
      turn(&value, sizeof(T));
    } else {
      T::_visit(value, *this);
    }
  }
  void read(std::string & value)
  {
    const std::size_t n = count(1);
    const char * text = take(n);
    value.assign(text, n != 0 && text[n - 1] == '\0' ? n - 1 : n);
  }
  void read(std::u16string & value)
  {
    const bool wide = wide_characters() != 2;
    value.resize(count(wide ? 4 : 2));
    for (char16_t & c : value) {
      if (wide) {
        std::uint32_t unit;
        read(unit);
        c = static_cast<char16_t>(unit);
      } else {
        std::uint16_t unit;
        read(unit);
        c = static_cast<char16_t>(unit);
      }
    }
  }
  template<typename T, std::size_t N>
  void read(std::array<T, N> & values) {elements(values);}
  template<typename T>
  void read(std::vector<T> & values) {values.resize(count(1)); elements(values);}
  template<typename T, std::size_t N>
  void read(rosidl_runtime_cpp::BoundedVector<T, N> & values) {values.resize(count(1)); elements(values);}

private:
  template<typename C>
  void elements(C & values)
  {
    using T = typename C::value_type;
    if constexpr (is_plain<T>) {
      if (values.size() != 0) {
        align(sizeof(T));
        std::memcpy(values.data(), take(values.size() * sizeof(T)), values.size() * sizeof(T));
        if (swap_) {
          for (T & value : values) {
            turn(&value, sizeof(T));
          }
        }
      }
    } else if constexpr (std::is_same<T, bool>::value) {
      for (std::size_t i = 0; i != values.size(); ++i) {
        values[i] = *take(1) != 0;
      }
    } else {
      for (T & value : values) {
        read(value);
      }
    }
  }
  /// Number of elements of at least `size` bytes each; checked before memory is taken for them.
  std::size_t count(std::size_t size)
  {
    std::uint32_t n;
    read(n);
    if (n > (size_ - at_) / size) {
      throw CdrError("a length in the message is larger than the message");
    }
    return n;
  }
  void align(std::size_t size) {at_ += (0 - (at_ - 4)) & (size - 1);}
  const char * take(std::size_t n)
  {
    if (at_ > size_ || n > size_ - at_) {
      throw CdrError("the message ends too early");
    }
    const char * found = data_ + at_;
    at_ += n;
    return found;
  }
  void turn(void * value, std::size_t size) const
  {
    char * bytes = static_cast<char *>(value);
    if (swap_) {
      for (std::size_t i = 0; i < size / 2; ++i) {
        std::swap(bytes[i], bytes[size - 1 - i]);
      }
    }
  }

  const char * data_;
  std::size_t size_;
  std::size_t at_ = 0;
  bool swap_ = false;
};

template<typename T>
void encode(const T & message, Bytes & out)
{
  CdrWriter writer(out);
  T::_visit(message, writer);
}

template<typename T>
void decode(const Bytes & data, T & message)
{
  CdrReader reader(data.data(), data.size());
  T::_visit(message, reader);
}
}  // namespace daidalos

#endif
