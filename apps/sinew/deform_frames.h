#pragma once
/// Bends the frames of a sequence, several at a time; what a frame becomes depends on that frame and the edit alone, so
/// that any split into threads or tasks gives the same bytes.

#include <optional>
#include <string>

#include "apps/sinew/files.h"
#include "engine/document/project.h"
#include "engine/document/report.h"
#include "engine/io/share.h"

namespace sinew::app {

struct FramesWork {
  std::string input, from;                   ///< as given, for messages
  std::shared_ptr<const Sequence> sequence;  ///< all frames: keys may lie outside of those that are written
  std::string frames;                        ///< which are written, "1-10x2"; empty: all
  Output out;
  int jobs = 1;                    ///< frames at a time
  std::optional<io::Share> share;  ///< this process writes its part of the frames only
  bool strict = false;
};

/// Writes the bent frames, tells of those that could not be bent, and fills in the layers and the count of frames of
/// `report`, where it is given. Returns an Exit: SomeFramesFailed where a part failed, Failed or BadInput where all
/// did.
int deform_frames(const FramesWork& work, const document::Project& project, document::Report* report);

}  // namespace sinew::app
