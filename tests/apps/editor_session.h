#pragma once
/// Waiting for a session, and what it says is wrong.

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

}  // namespace sinew::editor
