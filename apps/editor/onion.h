#pragma once
/// OnionSkin: the shape, bent, at some frames before and after the one shown, found by a thread of its own while
/// nothing moves.

#include <functional>
#include <memory>
#include <vector>

#include "apps/editor/background.h"
#include "engine/document/workspace.h"

namespace sinew::editor {

class Session;
struct View;

class OnionSkin {
 public:
  struct Ghost {
    int frame = 1, away = 1;             ///< steps from the frame shown: -2, -1, 1 ...
    std::shared_ptr<const Shape> shape;  ///< bent
  };

  explicit OnionSkin(std::function<void()> wake = {}) : work_(std::move(wake)) {}

  /// True where a ghost was found.
  bool poll();
  /// True where ghosts() changed: there are none while something plays, is dragged or is solved for.
  bool update(const Session& session, const View& view);
  const std::vector<Ghost>& ghosts() const { return ghosts_; }

 private:
  /// What the ghosts are of.
  struct Wanted {
    std::shared_ptr<const Sequence> sequence;
    document::Project project;
    int frame = 1, count = 0, step = 1;
    bool operator==(const Wanted&) const = default;
  };
  struct Found {
    Wanted wanted;
    std::vector<Ghost> ghosts;
  };

  void begin(const Session& session, const Wanted& wanted);

  std::vector<Ghost> ghosts_;
  std::optional<Wanted> shown_, begun_;
  std::optional<Found> found_;
  /// Kept from one frame to the next: it has the layers' structures. Only the thread uses it while work runs.
  std::shared_ptr<document::Workspace> workspace_;
  std::shared_ptr<const Sequence> workspace_of_;
  std::vector<Method> methods_;
  Background work_;
};

/// Frames `step` apart, at most `count` before and after the frame at `index`, nearest first: how far, and which.
std::vector<std::pair<int, int>> onion_frames(std::span<const int> frames, int frame, int count, int step);

}  // namespace sinew::editor
