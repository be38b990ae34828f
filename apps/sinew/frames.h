#pragma once
/// Sequences of frames for all commands: opening them with --frames, and writing all of their frames with progress.

#include <string>

#include "apps/sinew/files.h"
#include "engine/geometry/shape.h"

namespace sinew::app {

/// Opens a numbered run, a file of many frames or a still; `as`: the format of "-"; `frames`: the value of --frames, or
/// empty for all. Notes of the frames go to standard error, each once.
Sequence open_input(const std::string& path, const std::string& as, const std::string& frames);

/// Loads and writes each frame; what the format could not hold goes to standard error. Throws io::Cancelled after
/// Ctrl-C.
void write_frames(const Output& output, const Sequence& sequence);

}  // namespace sinew::app
