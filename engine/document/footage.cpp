#include "engine/document/footage.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "engine/document/settings.h"
#include "engine/geometry/error.h"

namespace sinew::document {

namespace {

constexpr std::size_t kept_frames = 8;

/// "1-48", "1, 3, 5-9"
std::string ranges(std::span<const int> frames) {
  std::string out;
  for (std::size_t i = 0; i < frames.size();) {
    std::size_t last = i;
    while (last + 1 < frames.size() && frames[last + 1] == frames[last] + 1) ++last;
    out += (out.empty() ? "" : ", ") + std::to_string(frames[i]);
    if (last > i) out += "-" + std::to_string(frames[last]);
    i = last + 1;
  }
  return out;
}

/// The attribute that tells particles apart; null where there is none.
const Attribute* ids_of(const Shape& shape) {
  for (const Attribute& attribute : shape.attributes)
    if (attribute.kind == Kind::Id && attribute.per_point() && attribute.components == 1) return &attribute;
  return nullptr;
}

InputError frame_error(int frame, const std::string& expected, const std::string& found) {
  return file_error("frame " + std::to_string(frame), expected, found);
}

/// The same coordinates relative to another origin. Exact where those of the file are: (p + o) is the file's.
std::shared_ptr<const Shape> at_origin(std::shared_ptr<const Shape> shape, const Vec3& origin) {
  if (shape->origin == origin) return shape;
  auto out = std::make_shared<Shape>(*shape);
  for (Vec3& p : out->positions) p = (p + shape->origin) - origin;
  out->origin = origin;
  return out;
}

void append(std::span<const Vec3> points, Shape& to) {
  to.positions.insert(to.positions.end(), points.begin(), points.end());
}

/// Frames of a sequence, one in `every`, from the first.
std::vector<int> sampled(std::span<const int> frames, int every) {
  std::vector<int> out;
  for (const int frame : frames)
    if ((frame - frames.front()) % every == 0) out.push_back(frame);
  return out;
}

}  // namespace

Footage::Footage(std::shared_ptr<const Sequence> sequence) : sequence_(std::move(sequence)) {
  CHECK(!sequence_->frames.empty());
}

void Footage::require(int frame, const Place& place, const std::string& what) const {
  if (still() || std::binary_search(sequence_->frames.begin(), sequence_->frames.end(), frame)) return;
  throw place_error(place, what, "a frame of the input (" + ranges(sequence_->frames) + ")", std::to_string(frame));
}

std::shared_ptr<const Shape> Footage::input(int frame) {
  const auto found =
      std::find_if(recent_.begin(), recent_.end(), [&](const auto& kept) { return kept.first == frame; });
  if (found != recent_.end()) {
    std::rotate(found, found + 1, recent_.end());
    return recent_.back().second;
  }
  if (first_ == nullptr) first_ = sequence_->load(first_frame());
  std::shared_ptr<const Shape> shape = first_;
  if (still()) return shape;
  if (frame != first_frame()) {
    require(frame, {}, "frame");
    shape = at_origin(sequence_->load(frame), first_->origin);
  }
  if (recent_.size() == kept_frames) recent_.erase(recent_.begin());
  recent_.emplace_back(frame, shape);
  return shape;
}

int Footage::frame_of(const Layer& layer) const {
  if (layer.frame) return *layer.frame;
  return layer.keys.empty() ? first_frame() : layer.keys.front().frame;
}

void Footage::set_layers(std::span<const Layer> layers) {
  Gathering wanted;
  bool stream = false;
  for (const Layer& layer : layers) {
    if (!layer.on) continue;
    if (layer.path) {
      stream = true;
      wanted.paths.push_back(*layer.path);
    }
    if (!stream || layer.frame) require(frame_of(layer), layer.place, "layer");
    const auto add = [&](const Selection& selection) {
      const int frame = selection.frame.value_or(frame_of(layer));
      require(frame, selection.place, "selection");
      wanted.frames.push_back(frame);
    };
    for (const Selection& selection : layer.nodes) add(selection);
    for (const Selection& selection : layer.fixed) add(selection);
    for (const HandleEdit& handle : layer.handles) add(handle.points);
    for (const Selection& selection : layer.rigid) add(selection);
    for (const Stiffness& stiffness : layer.stiffness) add(stiffness.points);
  }
  if (!stream) {
    gathered_ = nullptr;
    gathering_ = {};
    return;
  }
  std::sort(wanted.frames.begin(), wanted.frames.end());
  wanted.frames.erase(std::unique(wanted.frames.begin(), wanted.frames.end()), wanted.frames.end());
  if (gathered_ != nullptr && wanted == gathering_) return;
  gathering_ = std::move(wanted);
  gather();
}

void Footage::gather() {
  auto shape = std::make_shared<Shape>();
  shape->origin = input(first_frame())->origin;
  path_begins_.clear();
  frame_begins_.clear();
  for (const ParticlePath& path : gathering_.paths) {
    path_begins_.push_back(static_cast<Index>(shape->size()));
    append(samples(path), *shape);
  }
  path_begins_.push_back(static_cast<Index>(shape->size()));
  for (const int frame : gathering_.frames) {
    frame_begins_[frame] = static_cast<Index>(shape->size());
    append(input(frame)->positions, *shape);
  }
  gathered_ = std::move(shape);
}

std::vector<Vec3> Footage::samples(const ParticlePath& path) {
  const Vec3 origin = input(first_frame())->origin;
  std::vector<Vec3> out;
  if (!path.points.get().empty()) {
    for (const Vec3& p : path.points.get()) out.push_back(p - origin);
    return out;
  }
  // Where each particle is at the sampled frames: one of them is wanted, but which lives longest shows at the end.
  std::unordered_map<std::int64_t, std::vector<Vec3>> tracks;
  for (const int frame : sampled(sequence_->frames, path.every)) {
    const std::shared_ptr<const Shape> shape = input(frame);
    const Attribute* ids = ids_of(*shape);
    if (ids == nullptr)
      throw frame_error(frame, "ids of the particles, for the path of one", "no attribute of kind id");
    for (std::size_t i = 0; i < shape->size(); ++i) {
      const double id = ids->number(i, 0);
      if (path.id && id != *path.id) continue;
      if (shape->positions[i].allFinite()) tracks[static_cast<std::int64_t>(id)].push_back(shape->positions[i]);
    }
  }
  std::pair<std::size_t, std::int64_t> best{0, 0};
  for (const auto& [id, track] : tracks)
    if (track.size() > best.first || (track.size() == best.first && id < best.second)) best = {track.size(), id};
  if (best.first < 2)
    throw place_error(path.place, "path", "a particle that is there in two or more of the sampled frames",
                      path.id ? "the id in " + std::to_string(best.first) + " of them" : "none");
  return tracks[best.second];
}

std::shared_ptr<const Shape> Footage::carrier(int frame) {
  if (gathered_ != nullptr) return gathered_;
  std::shared_ptr<const Shape> shape = input(frame);
  if (shape == first_) return shape;
  const std::string place = " as in frame " + std::to_string(first_frame());
  const std::string advice = "; a layer with \"path\" bends streams, whose points come and go";
  if (shape->size() != first_->size())
    throw frame_error(frame, std::to_string(first_->size()) + " points" + place,
                      std::to_string(shape->size()) + advice);
  const Attribute *ids = ids_of(*shape), *first_ids = ids_of(*first_);
  if (ids != nullptr && first_ids != nullptr && ids->name == "id" && ids->values != first_ids->values)
    throw frame_error(frame, "the same ids in the same order" + place, "others" + advice);
  return shape;
}

Selector& Footage::selector(int frame) {
  std::unique_ptr<Selector>& kept = selectors_[frame];
  if (kept == nullptr) kept = std::make_unique<Selector>(input(frame));
  return *kept;
}

std::vector<Index> Footage::points(const Layer& layer, const Selection& selection, bool as_written) {
  const int frame = selection.frame.value_or(frame_of(layer));
  require(frame, selection.place, "selection");
  Selector& found = selector(frame);
  std::vector<Index> out = as_written ? found.points_as_written(selection) : found.points(selection);
  if (gathered_ == nullptr) return out;
  for (Index& i : out) i += frame_begins_.at(frame);
  return out;
}

std::vector<Index> Footage::path_points(const Layer& layer) const {
  std::vector<Index> out;
  if (!layer.path) return out;
  const auto found = std::find(gathering_.paths.begin(), gathering_.paths.end(), *layer.path);
  CHECK(found != gathering_.paths.end());
  const auto p = static_cast<std::size_t>(found - gathering_.paths.begin());
  for (Index i = path_begins_[p]; i < path_begins_[p + 1]; ++i) out.push_back(i);
  return out;
}

}  // namespace sinew::document
