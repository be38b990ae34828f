#include <algorithm>

#include "engine/io/motion.h"

namespace sinew::io {

namespace {

/// The place of one point in all frames, as it was read.
using Track = std::vector<Vec3>;

Track track_of(const Trajectories& motion, std::size_t point) {
  Track track(motion.frames.size());
  for (std::size_t f = 0; f < track.size(); ++f) track[f] = motion.frames[f][point];
  return track;
}

/// Runs of frames that were not seen, as pairs of the first and one behind the last, counted from 0.
std::vector<std::array<std::size_t, 2>> runs_of(const Track& track) {
  std::vector<std::array<std::size_t, 2>> runs;
  for (std::size_t f = 0; f < track.size(); ++f) {
    if (seen(track[f])) continue;
    if (f == 0 || seen(track[f - 1])) runs.push_back({f, f});
    runs.back()[1] = f + 1;
  }
  return runs;
}

/// Velocity at frame `at`, away from the gap; `step` leads away from it: -1 or 1. `chord` is the mean one over the gap.
Vec3 velocity(const Track& track, std::size_t at, int step, const Vec3& chord) {
  const auto there = [&](int i) -> const Vec3* {
    const std::ptrdiff_t f = static_cast<std::ptrdiff_t>(at) + i * step;
    const bool inside = f >= 0 && f < static_cast<std::ptrdiff_t>(track.size());
    return inside && seen(track[static_cast<std::size_t>(f)]) ? &track[static_cast<std::size_t>(f)] : nullptr;
  };
  const Vec3 *one = there(1), *two = there(2);
  if (one == nullptr) return chord;
  if (two == nullptr) return step * (*one - track[at]);
  return step * (4 * *one - 3 * track[at] - *two) / 2;
}

void bridge(Trajectories& motion, std::size_t point, const Track& track, std::size_t a, std::size_t b) {
  const double h = static_cast<double>(b - a);
  const Vec3 chord = (track[b] - track[a]) / h;
  const Vec3 va = h * velocity(track, a, -1, chord), vb = h * velocity(track, b, 1, chord);
  for (std::size_t f = a + 1; f < b; ++f) {
    const double s = static_cast<double>(f - a) / h, s2 = s * s, s3 = s2 * s;
    motion.frames[f][point] =
        (2 * s3 - 3 * s2 + 1) * track[a] + (s3 - 2 * s2 + s) * va + (3 * s2 - 2 * s3) * track[b] + (s3 - s2) * vb;
  }
}

std::string ranges(const std::vector<Gap>& gaps, bool bridged) {
  constexpr std::size_t shown = 8;
  std::string text;
  std::size_t count = 0;
  for (const Gap& gap : gaps) {
    if (gap.bridged != bridged || ++count > shown) continue;
    text += (count > 1 ? ", " : "") + std::to_string(gap.first);
    if (gap.last > gap.first) text += "-" + std::to_string(gap.last);
  }
  return " (" + text + (count > shown ? " and " + std::to_string(count - shown) + " more" : "") + ")";
}

GapReport report_of(Trajectories* filled, const Trajectories& motion, int longest) {
  GapReport report;
  for (std::size_t p = 0; p < motion.names.size(); ++p) {
    GapReport::Marker marker;
    marker.name = motion.names[p];
    const Track track = track_of(motion, p);
    for (const auto& [begin, end] : runs_of(track)) {
      const std::size_t size = end - begin;
      const bool bridged = filled != nullptr && begin > 0 && end < track.size() && longest > 0 &&
                           size <= static_cast<std::size_t>(longest);
      if (bridged) bridge(*filled, p, track, begin - 1, end);
      (bridged ? marker.bridged : marker.released) += size;
      marker.gaps.push_back(
          {motion.first_frame + static_cast<int>(begin), motion.first_frame + static_cast<int>(end) - 1, bridged});
    }
    report.bridged += marker.bridged;
    report.released += marker.released;
    report.markers.push_back(std::move(marker));
  }
  return report;
}

}  // namespace

std::vector<std::string> GapReport::sentences() const {
  std::vector<std::string> out;
  for (const Marker& marker : markers) {
    if (marker.gaps.empty()) continue;
    std::string text = marker.name + ": ";
    const auto frames = [](std::size_t n) { return std::to_string(n) + (n == 1 ? " frame" : " frames"); };
    if (marker.bridged > 0) text += frames(marker.bridged) + " bridged" + ranges(marker.gaps, true);
    if (marker.bridged > 0 && marker.released > 0) text += ", ";
    if (marker.released > 0) text += frames(marker.released) + " released" + ranges(marker.gaps, false);
    out.push_back(text + ".");
  }
  return out;
}

GapReport gaps_of(const Trajectories& motion) {
  return report_of(nullptr, motion, 0);
}

GapReport bridge_gaps(Trajectories& motion, int longest) {
  return report_of(&motion, motion, longest);
}

}  // namespace sinew::io
