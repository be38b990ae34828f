#include "engine/io/frame_times.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sinew::io {

namespace {

constexpr double ntsc = 1000.0 / 1001;

/// The nearest rate that people use, where one is near.
double snapped(double rate) {
  for (const double unit : {1.0, ntsc}) {
    const double near = std::round(rate / unit) * unit;
    if (near > 0 && std::abs(rate - near) < 1e-4 * near) return near;
  }
  return rate;
}

/// Empty where a time is no multiple of 1/rate, or two are one frame.
std::vector<int> frames_at(std::span<const float> times, double rate) {
  std::vector<int> frames;
  for (const float time : times) {
    const double x = rate * static_cast<double>(time), whole = std::round(x);
    // Times are floats: a late frame is known less well.
    if (!(std::abs(x - whole) < 1e-3 + 2e-7 * std::abs(x)) || std::abs(whole) > 1e8) return {};
    if (!frames.empty() && static_cast<int>(whole) <= frames.back()) return {};
    frames.push_back(static_cast<int>(whole));
  }
  return frames;
}

}  // namespace

FrameTimes frames_of_times(std::span<const float> times) {
  FrameTimes out;
  const auto try_rate = [&](double rate) {
    if (!(rate > 1e-3) || !(rate < 1e6)) return false;
    out.frames = frames_at(times, rate);
    if (!out.frames.empty()) out.rate = rate;
    return !out.frames.empty();
  };
  double step = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < times.size(); ++i)
    step = std::min(step, static_cast<double>(times[i]) - static_cast<double>(times[i - 1]));
  double average = 24;
  if (step > 0 && std::isfinite(step)) {
    // From the whole length, since the difference of two late times has few digits; first as if there were no gaps.
    const double length = static_cast<double>(times.back()) - static_cast<double>(times.front());
    average = static_cast<double>(times.size() - 1) / length;
    if (try_rate(snapped(average)) || try_rate(snapped(std::round(length / step) / length))) return out;
  }
  for (const double rate : {24.0, 25.0, 30.0, 60.0, 48.0, 50.0, 120.0, 24 * ntsc, 30 * ntsc})
    if (try_rate(rate)) return out;
  out.numbered = true;
  out.rate = std::isfinite(average) && average > 0 ? average : 24;
  for (std::size_t i = 0; i < times.size(); ++i) out.frames.push_back(static_cast<int>(i) + 1);
  return out;
}

}  // namespace sinew::io
