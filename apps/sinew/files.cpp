#include "apps/sinew/files.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <span>

#include "apps/sinew/command.h"
#include "apps/sinew/interrupt.h"
#include "apps/sinew/progress.h"
#include "engine/geometry/error.h"
#include "engine/io/io.h"
#include "engine/io/output_file.h"
#include "engine/io/sequence.h"

namespace sinew::app {

namespace {

bool is_folder(const std::string& path) {
  return path.ends_with('/');
}

/// Extensions of formats that can be written.
std::string writable() {
  std::string out;
  for (const io::Format& format : io::formats())
    if (format.write != nullptr)
      for (const std::string& extension : format.extensions) out += (out.empty() ? "." : ", .") + extension;
  return out;
}

void report_lost(const std::string& path, const io::WriteReport& report) {
  for (const std::string& lost : report.lost) message(path + ": " + lost);
}

}  // namespace

std::shared_ptr<const Shape> read_input(const std::string& path, const std::string& as) {
  if (path.find('#') != std::string::npos && !std::filesystem::exists(path))
    throw file_error(path, "one file", "the name of a sequence of frames");
  std::shared_ptr<const Shape> shape;
  {
    Progress progress("reading " + path);
    io::ReadOptions options;
    options.progress = [&](double fraction) { return progress(fraction); };
    shape = io::read(path, options, as);
  }
  for (const std::string& note : shape->notes) message(path + ": " + note);
  return shape;
}

std::shared_ptr<const Sequence> open_input(const std::string& path, const std::string& as) {
  Progress progress("reading " + path);
  io::ReadOptions options;
  options.progress = [&](double fraction) { return progress(fraction); };
  return std::make_shared<const Sequence>(io::open_sequence(path, options, as));
}

void check_output(const Output& output) {
  if (is_folder(output.path)) return;
  std::string extension = output.as;
  if (output.path != "-") extension = std::filesystem::path(output.path).extension().string();
  if (extension.starts_with('.')) extension.erase(0, 1);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  bool known = false;
  for (const io::Format& format : io::formats())
    for (const std::string& e : format.extensions) known = known || (e == extension && format.write != nullptr);
  if (!known) {
    const char* where = output.path == "-" ? "--to with an extension" : "a name";
    throw UsageError(fmt::format("{}: expected {} of a format that can be written ({}), found {}", output.path, where,
                                 writable(), extension.empty() ? "none" : sinew::quoted(extension)));
  }
  check_output_text(output.path, output.force);
}

void check_folder(const Output& output, const std::string& input, const Shape& shape) {
  if (!is_folder(output.path)) return;
  if (shape.parts.empty())
    throw UsageError(output.path + ": expected the name of a file for what is no scan set, found a folder for " +
                     input);
  for (const Part& part : shape.parts) check_output_text(output.path + part.path, output.force);
}

void check_output_text(const std::string& path, bool force) {
  const Writing writing;
  io::refuse_existing(path, force);
}

void write_output(const Output& output, const Shape& shape) {
  const Writing writing;
  const Progress progress("writing " + output.path);
  report_lost(output.path, is_folder(output.path) ? io::write_parts(output.path, shape, output.force)
                                                  : io::write(output.path, shape, output.force, output.as));
}

void write_output_text(const std::string& path, const std::string& text, bool force) {
  const Writing writing;
  io::save_bytes(path, std::as_bytes(std::span(text)), force);
}

void message(const std::string& text) {
  fmt::print(stderr, "sinew: {}\n", text);
}

}  // namespace sinew::app
