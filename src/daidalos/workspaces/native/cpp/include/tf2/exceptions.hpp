// What goes wrong when transforms are looked up.
#ifndef TF2__EXCEPTIONS_HPP_
#define TF2__EXCEPTIONS_HPP_

#include <stdexcept>
#include <string>

namespace tf2
{
class TransformException : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};
/// A frame is not known.
class LookupException : public TransformException {public: using TransformException::TransformException;};
/// Two frames are in different trees.
class ConnectivityException : public TransformException {public: using TransformException::TransformException;};
/// The time lies outside of what is known.
class ExtrapolationException : public TransformException {public: using TransformException::TransformException;};
class InvalidArgumentException : public TransformException {public: using TransformException::TransformException;};
class TimeoutException : public TransformException {public: using TransformException::TransformException;};
}  // namespace tf2
#endif
