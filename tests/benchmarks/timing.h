#pragma once
/// Times of what the tables show, in seconds.

#include <algorithm>
#include <chrono>
#include <vector>

namespace sinew::benchmarks {

template <class Body>
double seconds_of(const Body& body) {
  const auto begin = std::chrono::steady_clock::now();
  body();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[values.size() / 2];
}

/// Median of so many runs, each of as many calls as take 10 ms, per call.
template <class Body>
double median_of(int runs, const Body& body) {
  const double once = std::max(seconds_of(body), 1e-7);
  const int calls = std::clamp(static_cast<int>(0.01 / once), 1, 1000);
  std::vector<double> times;
  for (int r = 0; r < runs; ++r)
    times.push_back(seconds_of([&] {
                      for (int c = 0; c < calls; ++c) body();
                    }) /
                    calls);
  return median(std::move(times));
}

}  // namespace sinew::benchmarks
