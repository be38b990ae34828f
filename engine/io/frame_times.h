#pragma once
/// Frame numbers of times in seconds, for formats that have times only.

#include <span>
#include <vector>

namespace sinew::io {

struct FrameTimes {
  std::vector<int> frames;  ///< as many as times, ascending
  double rate = 24;         ///< frames a second
  bool numbered = false;    ///< the times are no multiples of 1/rate, so that frames are counted from 1
};

/// frame = rate x time, where a rate (a whole number, or one of 1000/1001 of it) makes all of them whole: first that of
/// the average step, that of the smallest, then 24, 25, 30, 60, 48, 50, 120, 24000/1001, 30000/1001.
FrameTimes frames_of_times(std::span<const float> times);

}  // namespace sinew::io
