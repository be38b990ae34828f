#include "apps/editor/lod.h"

#include <algorithm>

namespace sinew::editor {

std::size_t DetailController::begin_frame(std::size_t total, bool moving, double now) {
  if (total != total_) drawn_ = 0;
  total_ = total;
  if (moving) last_motion_ = now;
  // Where the base alone takes the frame, a quarter of it more for points is hardly felt, and seen.
  const double room = std::max({settings_.frame_seconds - base_, 0.1 * settings_.frame_seconds, 0.25 * base_});
  // A tenth is kept back: frames vary, and one that comes late is seen.
  const auto affordable = static_cast<std::size_t>(std::min(0.9 * room / cost_, 4e9));
  const std::size_t moving_count = std::min(total, std::max(settings_.least, affordable));
  if (now - last_motion_ < settings_.rest_seconds)
    drawn_ = moving_count;
  else
    drawn_ = std::min(total, std::max(moving_count, 2 * drawn_));
  return drawn_;
}

void DetailController::end_frame(double seconds) {
  if (drawn_ == 0 || !(seconds > 0)) return;
  // Too slow is corrected at once, too fast little by little. The base is what no count of points explains: it follows
  // only frames of few points, where the points' own share is small.
  if (drawn_ <= settings_.least)
    base_ +=
        0.2 * (std::clamp(seconds - cost_ * static_cast<double>(drawn_), 0.0, 4 * settings_.frame_seconds) - base_);
  const double measured = std::clamp((seconds - base_) / static_cast<double>(drawn_), 1e-10, 1e-4);
  cost_ += (measured > cost_ ? 0.7 : 0.15) * (measured - cost_);
}

}  // namespace sinew::editor
