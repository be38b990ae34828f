#pragma once
/// Reading and writing for all commands: progress, notes on standard error, outputs refused before the work starts.

#include <memory>
#include <string>

#include "engine/geometry/shape.h"

namespace sinew::app {

/// Reads a shape with progress; its notes go to standard error. `as`: the format of "-", by an extension.
std::shared_ptr<const Shape> read_input(const std::string& path, const std::string& as);

/// Opens frames, or a still as one; what it reads at once with progress.
std::shared_ptr<const Sequence> open_input(const std::string& path, const std::string& as);

/// A file, a folder for the parts of a scan set (it ends in '/'), or "-".
struct Output {
  std::string path;
  std::string as;  ///< the format of "-"
  bool force = false;
};

/// Throws UsageError where no format can be written under this name, InputError where the file exists without `force`.
void check_output(const Output& output);
/// The same for a folder, once the scan set that goes there is known.
void check_folder(const Output& output, const std::string& input, const Shape& shape);
void check_output_text(const std::string& path, bool force);

/// What the format could not hold goes to standard error.
void write_output(const Output& output, const Shape& shape);
void write_output_text(const std::string& path, const std::string& text, bool force);

/// "sinew: TEXT" on standard error.
void message(const std::string& text);

}  // namespace sinew::app
