#pragma once
/// Sequences of frames in files: a numbered run of files (frame_pattern.h: `name.####.ext`), a file that holds many
/// frames (PC2, MDD, glTF), or a still, which is a sequence of one frame. Reading loads a frame when it is asked for;
/// writing takes frames in any order and from any thread.

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/geometry/shape.h"
#include "engine/io/io.h"
#include "engine/io/share.h"

namespace sinew::io {

/// Whether a name is one of frames: a numbered run, or a file of a format that holds many ("-": of `as`).
bool names_frames(const std::string& path, const std::string& as = "");

/// Opens what `path` names; `as`: the format of "-", by an extension. `load` may be called from any thread and reads
/// its frame anew each time (a still was read already); it throws one sentence with path and frame where there is none.
/// Each frame has an origin of its own (Shape::origin). Throws InputError: nothing there, frames that the name of the
/// run lists and that are missing.
Sequence open_sequence(const std::string& path, const ReadOptions& options = {}, const std::string& as = "");

/// Only the frames of `text` ("10-20x2"). Throws InputError that names those of them that `all`, read from `path`, does
/// not have.
Sequence chosen_frames(Sequence all, const std::string& path, std::string_view text);

struct FrameWriterOptions {
  std::vector<int> frames;     ///< of the whole output, ascending; of all tasks
  double rate = 24;            ///< frames a second
  bool force = false;          ///< replaces what is there
  std::string as;              ///< the format of "-", by an extension
  std::optional<Share> share;  ///< this process writes frames[share.first(n)] .. frames[share.last(n) - 1] only

  /// Frames that this process writes.
  std::vector<int> own_frames() const;
};

/// Writes the frames of a sequence. Without commit() nothing is left of an output that is one file; of a run, frames
/// that were written stay, each whole.
class FrameWriter {
 public:
  virtual ~FrameWriter() = default;

  /// Each of the process's frames once. From any thread, in any order: the result has the same bytes. Throws
  /// InputError.
  virtual void write(int frame, const Shape& shape) = 0;
  /// Finishes the output: throws InputError where a file of many frames lacks some. What the format cannot hold, a
  /// sentence each, in the words of the first frame concerned.
  virtual WriteReport commit() = 0;
};

/// `path` is a numbered run, a file of a format with many frames, or, for one frame, any file. Refuses at once what
/// could not be written at the end: a format that is only read, existing files without `force`.
///
/// With a share, PC2 and MDD are written in place: the task that comes first makes the file in its full size, each
/// writes its frames where they belong, and a task that is run again writes the same bytes again. A file of another
/// size or header is refused without `force`. glTF can't be shared. A run of files is shared as it is.
std::unique_ptr<FrameWriter> create_frames(const std::string& path, const FrameWriterOptions& options);

}  // namespace sinew::io
