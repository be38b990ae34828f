#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>

#include "engine/geometry/error.h"
#include "engine/io/frame_losses.h"
#include "engine/io/frame_pattern.h"
#include "engine/io/gltf.h"
#include "engine/io/gltf_builder.h"
#include "engine/io/gltf_mesh.h"
#include "engine/io/output_file.h"
#include "engine/io/text.h"
#include "engine/io/text_patch.h"

namespace sinew::io {

namespace {

/// The float with which base + offset, rounded to float as most programs do, is `wanted`, or as near as can be.
float offset_to(float base, float wanted) {
  const float offset = wanted - base;
  if (base + offset == wanted) return offset;
  for (const float towards : {-std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity()})
    if (const float near = std::nextafter(offset, towards); base + near == wanted) return near;
  return offset;
}

/// Frames as they come, and the file of all of them.
class GltfWriter : public FrameWriter {
 public:
  GltfWriter(std::string path, const FrameWriterOptions& options, GltfContainer container)
      : path_(std::move(path)), options_(options), container_(container) {
    if (options_.share && options_.share->count > 1)
      throw file_error(path_, "one process, for a glTF file is written at once", "a share of its frames");
    if (options_.frames.front() < 0)
      throw file_error(path_, "frames of 0 and more, for glTF has no time below zero",
                       "frame " + std::to_string(options_.frames.front()));
    if (!(options_.rate > 0)) throw file_error(path_, "a rate above 0", shortest(options_.rate));
    refuse_existing(path_, options_.force);
  }

  void write(int frame, const Shape& shape) override {
    Frame kept;
    WriteReport report;
    kept.original = original_of(frame, shape);
    kept.positions = positions_of(shape, report);
    const std::scoped_lock lock(mutex_);
    if (frames_.empty()) {
      points_ = shape.size();
      faces_ = shape.faces;
    }
    if (shape.size() != points_)
      throw file_error(path_,
                       "as many points in frame " + std::to_string(frame) + " as in others, " + std::to_string(points_),
                       std::to_string(shape.size()));
    if (shape.faces.offsets != faces_.offsets || shape.faces.points != faces_.points)
      throw file_error(path_, "the faces of other frames in frame " + std::to_string(frame), "others");
    losses_.add(frame, std::move(report));
    frames_[frame] = std::move(kept);
  }

  WriteReport commit() override {
    WriteReport report;
    const std::vector<std::byte> bytes = finish(report);
    save_bytes(path_, bytes, options_.force);
    return report;
  }

  std::vector<std::byte> finish(WriteReport& report) {
    std::vector<int> missing;
    for (const int frame : options_.frames)
      if (!frames_.contains(frame)) missing.push_back(frame);
    if (!missing.empty())
      throw file_error(path_, "all of its " + std::to_string(options_.frames.size()) + " frames",
                       "no frame " + frames_text(missing));
    if (const GltfMesh* original = unchanged()) {
      const std::span<const std::byte> bytes = original->document().bytes();
      return {bytes.begin(), bytes.end()};
    }
    report = losses_.merged();
    return make(report);
  }

 private:
  struct Frame {
    std::vector<float> positions;
    std::shared_ptr<const GltfMesh> original;  ///< where it is what was read as this frame
  };

  std::shared_ptr<const GltfMesh> original_of(int frame, const Shape& shape) const {
    const auto* content = dynamic_cast<const GltfContent*>(shape.content.get());
    if (content == nullptr || content->mesh->frames()[content->frame] != frame || !shape.attributes.empty()) return {};
    Shape read = content->mesh->shape(content->frame);
    set_origin(read);
    const bool same = read.origin == shape.origin && read.positions == shape.positions &&
                      read.faces.offsets == shape.faces.offsets && read.faces.points == shape.faces.points;
    return same ? content->mesh : nullptr;
  }

  /// The file that all frames are from, unchanged, where its bytes can be copied.
  const GltfMesh* unchanged() const {
    const GltfMesh* original = frames_.begin()->second.original.get();
    if (original == nullptr || original->frames() != options_.frames || original->rate() != options_.rate)
      return nullptr;
    for (const auto& [frame, kept] : frames_)
      if (kept.original.get() != original) return nullptr;
    const bool same_kind = original->document().is_glb() == (container_ == GltfContainer::Glb);
    return same_kind && original->document().self_contained() ? original : nullptr;
  }

  std::vector<float> positions_of(const Shape& shape, WriteReport& report) const {
    if (shape.size() == 0) throw file_error(path_, "at least one point for glTF", "none");
    std::vector<float> out;
    out.reserve(3 * shape.size());
    std::size_t odd = 0;
    for (const Vec3& p : shape.positions) {
      const Eigen::Vector3f x = (p + shape.origin).cast<float>();
      const bool finite = x.allFinite();
      odd += finite ? 0 : 1;
      for (int c = 0; c < 3; ++c) out.push_back(finite ? x[c] : 0.0F);
    }
    if (odd > 0)
      report.lost.push_back("glTF cannot hold " + counted(odd, "point that is", "points that are") +
                            " not finite: written as 0 0 0.");
    const auto* content = dynamic_cast<const GltfContent*>(shape.content.get());
    if (content != nullptr)
      report.lost.push_back(
          "The other content of the glTF file that it came from (materials, attributes, nodes) is not "
          "written.");
    report_lost_precision("glTF", shape, report);
    report_lost_attributes("glTF", shape, {}, report);
    return out;
  }

  std::vector<Index> triangles(WriteReport& report) const {
    std::vector<Index> corners;
    std::size_t polygons = 0;
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      const auto face = faces_[f];
      polygons += face.size() > 3 ? 1 : 0;
      for (std::size_t c = 2; c < face.size(); ++c) corners.insert(corners.end(), {face[0], face[c - 1], face[c]});
    }
    if (polygons > 0)
      report.lost.push_back("glTF cannot hold " + counted(polygons, "face", "faces") +
                            " of more than 3 corners: cut into triangles.");
    return corners;
  }

  /// The positions of the first frame and the offsets of all others; the text of attributes and targets.
  std::string add_positions(GltfBuilder& builder) const {
    builder.begin_view(R"(,"byteStride":12,"target":34962)");
    const std::vector<float>& base = frames_.begin()->second.positions;
    std::string text = fmt::format(R"("attributes":{{"POSITION":{}}})", builder.add_floats(base, 3));
    std::vector<float> offsets(base.size());
    for (auto frame = std::next(frames_.begin()); frame != frames_.end(); ++frame) {
      for (std::size_t i = 0; i < base.size(); ++i) offsets[i] = offset_to(base[i], frame->second.positions[i]);
      text += fmt::format(R"({}{{"POSITION":{}}})", frame == std::next(frames_.begin()) ? R"(,"targets":[)" : ",",
                          builder.add_floats(offsets, 3));
    }
    return text + (frames_.size() > 1 ? "]" : "");
  }

  /// At the key of a frame its own weight is 1 and all others are 0; the first frame has none.
  std::string add_animation(GltfBuilder& builder) const {
    builder.begin_view("");
    const std::size_t targets = frames_.size() - 1;
    std::vector<float> times, weights(frames_.size() * targets, 0.0F);
    for (const auto& [frame, kept] : frames_) times.push_back(static_cast<float>(frame / options_.rate));
    for (std::size_t i = 1; i < frames_.size(); ++i) {
      if (!(times[i] > times[i - 1]))
        throw file_error(path_, "frames whose times differ as floats", shortest(times[i]) + " twice");
      weights[i * targets + i - 1] = 1;
    }
    const std::size_t input = builder.add_floats(times, 1), output = builder.add_floats(weights, 1);
    return fmt::format(
        R"("animations":[{{"name":"frames","samplers":[{{"input":{},"output":{},"interpolation":"LINEAR"}}],)"
        R"("channels":[{{"sampler":0,"target":{{"node":0,"path":"weights"}}}}]}}])",
        input, output);
  }

  std::vector<std::byte> make(WriteReport& report) const {
    const std::size_t size = frames_.size() * points_ * 12 + 4 * frames_.size() * frames_.size();
    if (size > most_gltf_bytes) throw file_error(path_, "at most 4 GiB for glTF", std::to_string(size) + " bytes");
    GltfBuilder builder;
    std::string primitive = add_positions(builder);
    const std::vector<Index> corners = triangles(report);
    if (corners.empty()) {
      primitive += R"(,"mode":0)";
    } else {
      builder.begin_view(R"(,"target":34963)");
      primitive += fmt::format(R"(,"indices":{},"mode":4)", builder.add_indices(corners));
    }
    std::string mesh = R"({"primitives":[{)" + primitive + "}]";
    if (frames_.size() > 1) {
      std::string weights, names;
      for (auto frame = std::next(frames_.begin()); frame != frames_.end(); ++frame) {
        weights += weights.empty() ? "0" : ",0";
        names += fmt::format(R"({}"frame {}")", names.empty() ? "" : ",", frame->first);
      }
      mesh += R"(,"weights":[)" + weights + R"(],"extras":{"targetNames":[)" + names + "]}";
    }
    std::string objects =
        "\n\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],\n\"meshes\":[" + mesh + "}]";
    if (frames_.size() > 1) objects += ",\n" + add_animation(builder);
    return builder.finish(path_, objects, container_);
  }

  std::string path_;
  FrameWriterOptions options_;
  GltfContainer container_;
  std::mutex mutex_;  ///< of what follows
  std::map<int, Frame> frames_;
  std::size_t points_ = 0;
  Faces faces_;
  FrameLosses losses_;
};

std::vector<std::byte> write_still(const std::string& path, const Shape& shape, WriteReport& report,
                                   GltfContainer container) {
  // Frame 1, or, so that an unchanged file of one frame is copied, the frame and rate of that file.
  FrameWriterOptions options;
  options.frames = {1};
  options.force = true;
  const auto* content = dynamic_cast<const GltfContent*>(shape.content.get());
  if (content != nullptr && content->mesh->frames().size() == 1 && content->mesh->frames().front() >= 0) {
    options.frames = content->mesh->frames();
    options.rate = content->mesh->rate();
  }
  GltfWriter writer(path, options, container);
  writer.write(options.frames.front(), shape);
  return writer.finish(report);
}

}  // namespace

std::vector<std::byte> write_gltf(const std::string& path, const Shape& shape, WriteReport& report) {
  return write_still(path, shape, report, GltfContainer::Gltf);
}

std::vector<std::byte> write_glb(const std::string& path, const Shape& shape, WriteReport& report) {
  return write_still(path, shape, report, GltfContainer::Glb);
}

std::unique_ptr<FrameWriter> create_gltf(const std::string& path, const FrameWriterOptions& options) {
  return std::make_unique<GltfWriter>(path, options, GltfContainer::Gltf);
}

std::unique_ptr<FrameWriter> create_glb(const std::string& path, const FrameWriterOptions& options) {
  return std::make_unique<GltfWriter>(path, options, GltfContainer::Glb);
}

}  // namespace sinew::io
