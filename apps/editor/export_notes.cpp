#include "apps/editor/export_notes.h"

#include <unistd.h>

#include <filesystem>

#include "apps/editor/background.h"
#include "engine/io/frame_pattern.h"
#include "engine/io/sequence.h"

namespace sinew::editor {

namespace {

namespace fs = std::filesystem;

/// A folder that goes with all that is in it.
struct TemporaryFolder {
  fs::path path = fs::temp_directory_path() / ("sinew-export-" + std::to_string(getpid()));
  TemporaryFolder() { fs::create_directories(path); }
  ~TemporaryFolder() {
    std::error_code error;
    fs::remove_all(path, error);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
};

/// What the writer of a file of many frames says of one of them.
std::vector<std::string> lost_of_frames(const std::string& path, const Shape& shape, double rate) {
  const TemporaryFolder folder;
  io::FrameWriterOptions options;
  options.frames = {1};
  options.rate = rate;
  const std::unique_ptr<io::FrameWriter> writer =
      io::create_frames((folder.path / ("frames" + fs::path(path).extension().string())).string(), options);
  writer->write(1, shape);
  return writer->commit().lost;
}

std::vector<std::string> lost_of(const std::string& path, const Shape& shape, double rate) {
  if (io::format_of(path).create_frames != nullptr) return lost_of_frames(path, shape, rate);
  io::WriteReport report;
  io::files_of(io::format_of(path), path, shape, report);
  return report.lost;
}

}  // namespace

std::vector<std::string> export_notes(const std::string& path, const Shape& shape, const Sequence& sequence,
                                      int frame) {
  std::vector<std::string> out;
  const std::string failure = sentence_of_failure([&] {
    const io::Format& format = io::format_of(path);
    if (format.write == nullptr && format.create_frames == nullptr) return;
    out = lost_of(path, shape, sequence.rate);
    if (sequence.frames.size() < 2 || io::names_frames(path)) return;
    out.push_back("Only frame " + std::to_string(frame) + " of " + std::to_string(sequence.frames.size()) +
                  " is written; a name with #### before its ending writes all of them.");
  });
  if (!failure.empty()) return {};
  return out;
}

}  // namespace sinew::editor
