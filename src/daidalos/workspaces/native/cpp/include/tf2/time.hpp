// Times of transforms.
#ifndef TF2__TIME_HPP_
#define TF2__TIME_HPP_

#include <chrono>

namespace tf2
{
using Duration = std::chrono::nanoseconds;
using TimePoint = std::chrono::time_point<std::chrono::system_clock, Duration>;
using IDuration = std::chrono::duration<int, std::nano>;

/// Stands for the latest time at which a transform is known.
constexpr TimePoint TimePointZero = TimePoint(Duration::zero());

inline TimePoint get_now() {return std::chrono::time_point_cast<Duration>(std::chrono::system_clock::now());}
inline Duration durationFromSec(double s) {return Duration(static_cast<Duration::rep>(s * 1e9));}
inline TimePoint timeFromSec(double s) {return TimePoint(durationFromSec(s));}
inline double durationToSec(const Duration & length) {return static_cast<double>(length.count()) * 1e-9;}
inline double timeToSec(const TimePoint & time) {return durationToSec(time.time_since_epoch());}
}  // namespace tf2
#endif
