#pragma once
/// Waiting for a session, what it says is wrong, and what a user does in it.

#include <chrono>
#include <functional>
#include <string>
#include <thread>

#include "apps/editor/session.h"

namespace sinew::editor {

inline bool until(Session& session, const std::function<bool()>& done) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(120);
  while (std::chrono::steady_clock::now() < end) {
    session.poll();
    if (done()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

inline bool settle(Session& session) {
  return until(session, [&] { return !session.solving() && !session.job(); });
}

inline std::string errors_of(Session& session) {
  std::string out;
  for (const Notice& notice : session.take_notices())
    if (notice.severity == Severity::Error) out += notice.text + "\n";
  return out;
}

inline Transform move_by(const Vec3& move) {
  Transform out;
  out.move = move;
  return out;
}

inline Transform turn_by(const Vec3& axis, double degrees, const Vec3& pivot) {
  Transform out;
  out.axis = axis;
  out.degrees = degrees;
  out.pivot = pivot;
  return out;
}

/// Marks the points whose places in the file are `in`.
inline void mark_where(Session& session, Mark what, const std::function<bool(const Vec3&)>& in) {
  PointSet set(session.input()->size());
  for (std::size_t i = 0; i < set.size(); ++i)
    if (in(session.input()->positions[i] + session.input()->origin)) set.add(i);
  session.select(set, SelectMode::Replace);
  session.mark_selection(what);
}

}  // namespace sinew::editor
