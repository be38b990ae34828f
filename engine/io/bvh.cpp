#include "engine/io/bvh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "engine/io/bytes.h"
#include "engine/io/text.h"
#include "engine/io/words.h"

namespace sinew::io {

namespace {

struct Channel {
  int axis = 0;
  bool rotates = false;
};

struct Joint {
  std::string name;
  int parent = -1;
  bool end = false;
  std::optional<Vec3> offset;
  std::vector<Channel> channels;
  bool has_channels = false;  ///< the word stood there, with any count
};

/// Walks over the file; joints come parents first.
class BvhReader {
 public:
  BvhReader(const std::string& path, std::string_view text) : path_(path), size_(text.size()), cursor_(path, text) {}

  Trajectories read() {
    read_hierarchy();
    Trajectories out;
    read_motion_head(out);
    read_rows(out);
    return out;
  }

 private:
  Token next_of_line() { return cursor_.word("{}"); }
  Token next() {
    Token token = next_of_line();
    while (token.text.empty() && !cursor_.at_end()) {
      cursor_.next_line();
      token = next_of_line();
    }
    return token;
  }

  Token expect(const char* word) {
    const Token token = next();
    if (!same_word(token.text, word)) throw wrong(token, std::string("\"") + word + "\"");
    return token;
  }

  InputError wrong(const Token& token, const std::string& expected) const {
    return token.text.empty() ? cursor_.error_at_end(token, expected) : cursor_.error(token, expected);
  }

  /// The next number of this line.
  double number(const std::string& what) {
    const Token token = next_of_line();
    double x = 0;
    if (!parse(token.text, x) || !std::isfinite(x)) throw cursor_.error(token, what);
    return x;
  }

  void read_hierarchy();
  void read_member(const Token& token, std::vector<int>& open);
  void open_joint(int parent, bool end);
  std::vector<Channel> read_channels();
  void read_motion_head(Trajectories& out);
  void read_rows(Trajectories& out);
  void add_rest(Trajectories& out) const;
  void add_frame(Trajectories& out, const double* values) const;

  std::string path_;
  std::size_t size_;
  TextCursor cursor_;
  std::vector<Joint> joints_;
  std::size_t channels_ = 0;
  double said_frames_ = 0;
};

/// "ROOT", "JOINT" or "End" was read: its name up to the brace, and the brace. Names may have blanks.
void BvhReader::open_joint(int parent, bool end) {
  constexpr std::size_t longest = 255;  // an end has its joint's name too
  const std::int64_t line = cursor_.line();
  std::string_view name;
  Token token = next_of_line();
  const Token first = token;
  for (; !token.text.empty() && token.text != "{"; token = next_of_line())
    name = {first.text.data(), token.begin + token.text.size() - first.begin};
  if (!end && (name.empty() || name.size() > longest))
    throw text_error(path_, line, 0, "the name of a joint, of at most " + std::to_string(longest) + " bytes",
                     quoted(name));
  if (token.text.empty()) expect("{");
  Joint joint;
  joint.name = end ? joints_[static_cast<std::size_t>(parent)].name + " end" : std::string(name);
  joint.parent = parent;
  joint.end = end;
  joints_.push_back(std::move(joint));
}

std::vector<Channel> BvhReader::read_channels() {
  const Token token = next_of_line();
  std::int64_t count = 0;
  if (!parse(token.text, count) || count < 0) throw cursor_.error(token, "the count of channels");
  std::vector<Channel> channels;
  for (std::int64_t i = 0; i < count; ++i) {
    const Token name = next();
    const std::string_view text = name.text;
    const std::size_t axis = text.empty() ? std::string_view::npos : std::string_view("XYZxyz").find(text.front());
    const bool rotates = !text.empty() && same_word(text.substr(1), "rotation");
    if (axis == std::string_view::npos || (!rotates && !same_word(text.substr(1), "position")))
      throw wrong(name, "a channel (Xposition ... Zrotation)");
    channels.push_back({static_cast<int>(axis % 3), rotates});
  }
  channels_ += channels.size();
  return channels;
}

/// `open`: the joints whose braces are open, without recursion, as a file may nest them deeply.
void BvhReader::read_member(const Token& token, std::vector<int>& open) {
  const int own = open.back();
  Joint& joint = joints_[static_cast<std::size_t>(own)];
  if (token.text == "}") {
    if (!joint.offset) throw cursor_.error(token, "OFFSET");
    open.pop_back();
  } else if (same_word(token.text, "OFFSET") && !joint.offset) {
    Vec3 offset;
    for (int c = 0; c < 3; ++c) offset[c] = number("three numbers of an OFFSET");
    joint.offset = offset;
  } else if (same_word(token.text, "CHANNELS") && !joint.has_channels && !joint.end) {
    joint.channels = read_channels();
    joint.has_channels = true;
  } else if (!joint.end && (same_word(token.text, "JOINT") || same_word(token.text, "End"))) {
    open.push_back(static_cast<int>(joints_.size()));
    open_joint(own, !same_word(token.text, "JOINT"));
  } else {
    throw wrong(token, joint.end ? "OFFSET or \"}\" of an end" : "OFFSET, CHANNELS, JOINT, End Site or \"}\"");
  }
}

void BvhReader::read_hierarchy() {
  expect("HIERARCHY");
  for (;;) {
    const Token token = next();
    if (same_word(token.text, "MOTION") && !joints_.empty()) break;
    if (!same_word(token.text, "ROOT")) throw wrong(token, joints_.empty() ? "ROOT" : "ROOT or MOTION");
    std::vector<int> open{static_cast<int>(joints_.size())};
    open_joint(-1, false);
    while (!open.empty()) read_member(next(), open);
  }
  if (channels_ == 0) throw file_error(path_, "at least one channel", "0");
}

/// "Frames: 12" and "Frame Time: 0.04". The count of frames is that of the rows; this one is only compared.
void BvhReader::read_motion_head(Trajectories& out) {
  const auto value_of = [&](const char* key) {
    std::string_view text;
    std::int64_t line = cursor_.line();
    while (text.empty() && !cursor_.at_end()) {
      line = cursor_.line();
      text = trimmed(cursor_.rest());
      cursor_.next_line();
    }
    const std::size_t colon = std::min(text.find(':'), text.size());
    double x = 0;
    if (!same_word(trimmed(text.substr(0, colon)), key) || colon == text.size() ||
        !parse(trimmed(text.substr(colon + 1)), x))
      throw text_error(path_, line, 0, std::string("\"") + key + ": NUMBER\"", quoted(text));
    return x;
  };
  said_frames_ = value_of("Frames");
  const double step = value_of("Frame Time");
  out.rate = rate_of_step(step);
  if (out.rate == 0) out.notes.push_back("Its Frame Time is " + shortest(step) + ": the rate is not known.");
}

void BvhReader::read_rows(Trajectories& out) {
  std::vector<double> values;
  for (Token token = cursor_.next(); !token.text.empty(); token = cursor_.next()) {
    const std::size_t row = values.size() / channels_ + 1;
    for (std::size_t i = 0; i < channels_; ++i, token = i < channels_ ? cursor_.token() : token) {
      double x = 0;
      if (!parse(token.text, x) || !std::isfinite(x))
        throw cursor_.error(token, "value " + std::to_string(i + 1) + " of " + std::to_string(channels_) + " of row " +
                                       std::to_string(row));
      values.push_back(x);
    }
    if (const Token more = cursor_.token(); !more.text.empty())
      throw cursor_.error(more, "the end of the line after " + std::to_string(channels_) + " values");
  }
  const std::size_t frames = values.size() / channels_;
  if (frames == 0) throw file_error(path_, "at least one frame", "0");
  if (static_cast<double>(frames) != said_frames_)
    out.notes.push_back("It says " + shortest(said_frames_) + " frames and has " + std::to_string(frames) +
                        ", which are read.");
  check_places(path_, frames, joints_.size(), size_);
  add_rest(out);
  for (std::size_t f = 0; f < frames; ++f) add_frame(out, &values[f * channels_]);
}

void BvhReader::add_rest(Trajectories& out) const {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const Joint& joint = joints_[i];
    out.names.push_back(joint.name);
    if (joint.parent >= 0) out.bones.push_back({joint.parent, static_cast<int>(i)});
    out.rest.push_back(joint.parent < 0 ? *joint.offset
                                        : out.rest[static_cast<std::size_t>(joint.parent)] + *joint.offset);
  }
}

/// Forward kinematics of one row.
void BvhReader::add_frame(Trajectories& out, const double* values) const {
  std::vector<Eigen::Matrix3d> turns(joints_.size());
  std::vector<Vec3> places(joints_.size());
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const Joint& joint = joints_[i];
    Vec3 place = *joint.offset;
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    for (const Channel& channel : joint.channels) {
      const double x = *values++;
      if (channel.rotates)
        turn *= Eigen::AngleAxisd(x * std::numbers::pi / 180, Vec3::Unit(channel.axis)).toRotationMatrix();
      else
        place[channel.axis] = x;
    }
    const auto parent = static_cast<std::size_t>(joint.parent);
    turns[i] = joint.parent < 0 ? turn : turns[parent] * turn;
    places[i] = joint.parent < 0 ? place : places[parent] + turns[parent] * place;
  }
  std::vector<Eigen::Matrix<double, 3, 4>> maps(joints_.size());
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    maps[i] << turns[i], places[i] - turns[i] * out.rest[i];
    if (!seen(places[i])) places[i] = not_seen;  // sums of lengths near the largest double
  }
  out.frames.push_back(std::move(places));
  out.transforms.push_back(std::move(maps));
}

}  // namespace

Trajectories read_bvh(const std::string& path, std::span<const std::byte> bytes) {
  return BvhReader(path, as_text(bytes)).read();
}

}  // namespace sinew::io
