#include "engine/io/sequence.h"

#include <algorithm>
#include <filesystem>
#include <mutex>
#include <set>

#include "engine/geometry/error.h"
#include "engine/io/byte_source.h"
#include "engine/io/frame_losses.h"
#include "engine/io/frame_pattern.h"
#include "engine/io/output_file.h"

namespace sinew::io {

namespace {

/// Those of ascending `wanted` that ascending `present` lacks.
std::vector<int> missing_of(const std::vector<int>& wanted, const std::vector<int>& present) {
  std::vector<int> missing;
  std::set_difference(wanted.begin(), wanted.end(), present.begin(), present.end(), std::back_inserter(missing));
  return missing;
}

/// The frames that are there, as found in an error.
std::string present_text(const std::vector<int>& frames) {
  return frames.empty() ? "none" : "only " + frames_text(frames);
}

/// `load` refuses a frame that is not in `frames`.
Sequence checked(Sequence sequence, const std::string& path) {
  sequence.load = [frames = sequence.frames, path, load = std::move(sequence.load)](int frame) {
    if (!std::binary_search(frames.begin(), frames.end(), frame))
      throw file_error(path, "frame " + std::to_string(frame), present_text(frames));
    return load(frame);
  };
  return sequence;
}

Sequence open_run(const FramePattern& pattern) {
  Sequence run;
  run.frames = frames_on_disk(pattern);
  if (run.frames.empty())
    throw file_error(pattern.text, "a file a frame, such as " + pattern.path(1), "no file of such a name");
  if (!pattern.frames.empty()) {
    const std::vector<int> missing = missing_of(pattern.frames, run.frames);
    if (!missing.empty())
      throw file_error(pattern.text, "all frames of the name", "no file of frame " + frames_text(missing));
    run.frames = pattern.frames;
  }
  format_of(pattern.path(run.frames.front()));
  run.load = [pattern](int frame) { return read(pattern.path(frame)); };
  return run;
}

/// Each frame a file of its own.
class RunWriter : public FrameWriter {
 public:
  RunWriter(FramePattern pattern, const FrameWriterOptions& options)
      : pattern_(std::move(pattern)), force_(options.force) {
    if (!pattern_.frames.empty() && pattern_.frames != options.frames)
      throw file_error(pattern_.text, "a name with the frames that are written, " + frames_text(options.frames),
                       frames_text(pattern_.frames));
    const Format& format = format_of(pattern_.path(options.frames.front()));
    if (format.write == nullptr)
      throw file_error(pattern_.text, "a format that has a file a frame", sinew::quoted(format.name));
    for (const int frame : options.own_frames()) refuse_existing(pattern_.path(frame), force_);
  }
  void write(int frame, const Shape& shape) override {
    losses_.add(frame, io::write(pattern_.path(frame), shape, force_));
  }
  WriteReport commit() override { return losses_.merged(); }

 private:
  FramePattern pattern_;
  bool force_;
  FrameLosses losses_;
};

/// One frame, one file.
class StillWriter : public FrameWriter {
 public:
  StillWriter(const std::string& path, const FrameWriterOptions& options)
      : path_(path), as_(options.as), force_(options.force) {
    format_of(path, as_);
    refuse_existing(path, force_);
  }
  void write(int, const Shape& shape) override { report_ = io::write(path_, shape, force_, as_); }
  WriteReport commit() override { return report_; }

 private:
  std::string path_, as_;
  bool force_;
  WriteReport report_;
};

/// Frames in a file of a format that holds no tets: says so where a frame has some.
class TellingWriter : public FrameWriter {
 public:
  TellingWriter(const Format& format, std::unique_ptr<FrameWriter> writer)
      : format_(format), writer_(std::move(writer)) {}
  void write(int frame, const Shape& shape) override {
    WriteReport report;
    report_lost_tets(format_, shape.tets.size(), report);
    losses_.add(frame, std::move(report));
    writer_->write(frame, shape);
  }
  WriteReport commit() override {
    WriteReport report = writer_->commit();
    for (std::string& sentence : losses_.merged().lost) report.lost.push_back(std::move(sentence));
    return report;
  }

 private:
  const Format& format_;
  std::unique_ptr<FrameWriter> writer_;
  FrameLosses losses_;
};

}  // namespace

bool names_frames(const std::string& path, const std::string& as) {
  if (path.ends_with('/') || (path == "-" && as.empty())) return false;
  if (frame_pattern(path)) return true;
  std::string extension = path == "-" ? as : std::filesystem::path(path).extension().string();
  if (extension.starts_with('.')) extension.erase(0, 1);
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  for (const Format& format : formats())
    if (format.open_frames != nullptr && std::count(format.extensions.begin(), format.extensions.end(), extension) > 0)
      return true;
  return false;
}

Sequence open_sequence(const std::string& path, const ReadOptions& options, const std::string& as) {
  if (const std::optional<FramePattern> pattern = frame_pattern(path)) return checked(open_run(*pattern), path);
  const Format& format = format_of(path, as);
  if (format.open_frames != nullptr) return checked(format.open_frames(open_bytes(path), options), path);
  return checked(still(read(path, options, as)), path);
}

Sequence chosen_frames(Sequence all, const std::string& path, std::string_view text) {
  std::vector<int> frames = parse_frames("--frames", text);
  std::sort(frames.begin(), frames.end());
  if (const std::vector<int> missing = missing_of(frames, all.frames); !missing.empty())
    throw file_error(path, "the frames " + std::string(text),
                     "no frame " + frames_text(missing) + " among " + frames_text(all.frames));
  all.frames = std::move(frames);
  return all;
}

std::vector<int> FrameWriterOptions::own_frames() const {
  if (!share) return frames;
  const auto at = [this](std::size_t i) { return frames.begin() + static_cast<std::ptrdiff_t>(i); };
  return {at(share->first(frames.size())), at(share->last(frames.size()))};
}

std::unique_ptr<FrameWriter> create_frames(const std::string& path, const FrameWriterOptions& options) {
  CHECK(!options.frames.empty() && std::is_sorted(options.frames.begin(), options.frames.end()));
  CHECK(!options.share || (options.share->index >= 1 && options.share->index <= options.share->count));
  if (std::optional<FramePattern> pattern = frame_pattern(path))
    return std::make_unique<RunWriter>(std::move(*pattern), options);
  const Format& format = format_of(path, options.as);
  if (format.create_frames != nullptr)
    return std::make_unique<TellingWriter>(format, format.create_frames(path, options));
  if (options.frames.size() > 1)
    throw file_error(path,
                     "a name with a place for the frame, like name.####.ply, for " +
                         std::to_string(options.frames.size()) + " frames",
                     "the name of one file");
  return std::make_unique<StillWriter>(path, options);
}

}  // namespace sinew::io
