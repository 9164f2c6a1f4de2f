// Vector with an upper bound on its length, as generated messages use it.
#ifndef ROSIDL_RUNTIME_CPP__BOUNDED_VECTOR_HPP_
#define ROSIDL_RUNTIME_CPP__BOUNDED_VECTOR_HPP_

#include <cstddef>
#include <initializer_list>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

namespace rosidl_runtime_cpp
{
/// Vector of at most `UpperBound` elements; what would exceed it throws std::length_error.
template<typename T, std::size_t UpperBound, typename Allocator = std::allocator<T>>
class BoundedVector : protected std::vector<T, Allocator>
{
  using Base = std::vector<T, Allocator>;

public:
  using typename Base::const_iterator;
  using typename Base::const_reference;
  using typename Base::iterator;
  using typename Base::reference;
  using typename Base::size_type;
  using typename Base::value_type;
  using Base::back;
  using Base::begin;
  using Base::capacity;
  using Base::cbegin;
  using Base::cend;
  using Base::clear;
  using Base::empty;
  using Base::end;
  using Base::erase;
  using Base::front;
  using Base::pop_back;
  using Base::rbegin;
  using Base::rend;
  using Base::size;
  using Base::operator[];
  using Base::at;

  BoundedVector() = default;
  explicit BoundedVector(size_type n, const T & value = T()) : Base(checked(n), value) {}
  BoundedVector(std::initializer_list<T> values) : Base(values) {checked(size());}
  BoundedVector(const std::vector<T, Allocator> & values) : Base(values) {checked(size());}  // NOLINT
  template<typename Iterator, typename = typename std::iterator_traits<Iterator>::iterator_category>
  BoundedVector(Iterator first, Iterator last) : Base(first, last) {checked(size());}

  // std::vector<bool> has no data().
  template<typename B = Base>
  auto data() -> decltype(static_cast<B &>(*this).data()) {return static_cast<B &>(*this).data();}
  template<typename B = Base>
  auto data() const -> decltype(static_cast<const B &>(*this).data()) {return static_cast<const B &>(*this).data();}
  size_type max_size() const noexcept {return UpperBound;}
  void reserve(size_type n) {Base::reserve(checked(n));}
  void resize(size_type n) {Base::resize(checked(n));}
  void resize(size_type n, const T & value) {Base::resize(checked(n), value);}
  void push_back(const T & value) {checked(size() + 1); Base::push_back(value);}
  void push_back(T && value) {checked(size() + 1); Base::push_back(std::move(value));}
  template<typename ... Args>
  reference emplace_back(Args && ... args)
  {
    checked(size() + 1);
    return Base::emplace_back(std::forward<Args>(args)...);
  }
  template<typename Iterator>
  void assign(Iterator first, Iterator last) {Base values(first, last); checked(values.size()); Base::swap(values);}

  friend bool operator==(const BoundedVector & a, const BoundedVector & b)
  {
    return static_cast<const Base &>(a) == static_cast<const Base &>(b);
  }
  friend bool operator!=(const BoundedVector & a, const BoundedVector & b) {return !(a == b);}

private:
  static size_type checked(size_type n)
  {
    if (n > UpperBound) {
      throw std::length_error("Exceeded upper bound");
    }
    return n;
  }
};
}  // namespace rosidl_runtime_cpp

#endif
