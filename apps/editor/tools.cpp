#include "apps/editor/tools.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/geometry/parallel.h"

namespace sinew::editor {

namespace {

constexpr std::size_t word_block = 256;  // 16,384 points
constexpr float nowhere = std::numeric_limits<float>::quiet_NaN();

/// Points of `rect` for which inside(x, y) holds, of those that `depth` reaches.
template <class Inside>
PointSet touched(const ScreenPoints& points, const ScreenRect& rect, Depth depth, const Inside& inside) {
  PointSet out(points.size());
  const PointSet* visible = depth == Depth::VisibleOnly ? &points.visible(rect) : nullptr;
  const std::span<std::uint64_t> words = out.words();
  const std::span<const float> x = points.x(), y = points.y();
  const Eigen::Vector2f min = rect.min.cast<float>(), max = rect.max.cast<float>();
  parallel_for(words.size(), word_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t w = begin; w < end; ++w) {
      const std::size_t first = 64 * w, count = std::min<std::size_t>(64, points.size() - first);
      std::uint64_t bits = 0;
      for (std::size_t b = 0; b < count; ++b) {
        const float px = x[first + b], py = y[first + b];
        const bool in = px >= min.x() && px <= max.x() && py >= min.y() && py <= max.y();
        bits |= static_cast<std::uint64_t>(in) << b;
      }
      if (visible != nullptr) bits &= visible->words()[w];
      std::uint64_t kept = 0;
      for (std::uint64_t rest = bits; rest != 0; rest &= rest - 1) {
        const auto b = static_cast<std::size_t>(__builtin_ctzll(rest));
        kept |= static_cast<std::uint64_t>(inside(x[first + b], y[first + b])) << b;
      }
      words[w] = kept;
    }
  });
  out.recount();
  return out;
}

/// A depth picture of cells, and coarser ones made of it: the nearest depth and the number of points of each cell.
struct DepthLevel {
  std::size_t columns = 0, rows = 0;
  float cell = 0;  ///< pixels
  std::vector<float> nearest;
  std::vector<std::uint32_t> count;

  std::size_t cell_of(float x, float y) const {
    return static_cast<std::size_t>(y / cell) * columns + static_cast<std::size_t>(x / cell);
  }
};

constexpr float finest_cell = 3;     // pixels
constexpr int levels = 5;            // the coarsest cell is 48 pixels
constexpr std::uint32_t enough = 8;  // points in a cell, so that its nearest one is of the front surface

DepthLevel empty_level(const Eigen::Vector2d& size, float cell) {
  DepthLevel level;
  level.cell = cell;
  level.columns = static_cast<std::size_t>(size.x() / cell) + 1;
  level.rows = static_cast<std::size_t>(size.y() / cell) + 1;
  level.nearest.assign(level.columns * level.rows, std::numeric_limits<float>::infinity());
  level.count.assign(level.columns * level.rows, 0);
  return level;
}

DepthLevel finest_level(const ScreenPoints& points, const Eigen::Vector2d& size) {
  // Few, long blocks: each has a picture of its own. The nearest of all does not depend on how many there are.
  constexpr std::size_t blocks = 4;
  const std::size_t n = points.size(), block = std::max<std::size_t>(1, (n + blocks - 1) / blocks);
  std::vector<DepthLevel> parts((n + block - 1) / block);
  const auto width = static_cast<float>(size.x()), height = static_cast<float>(size.y());
  parallel_for(n, block, [&](std::size_t begin, std::size_t end) {
    DepthLevel& level = parts[begin / block];
    level = empty_level(size, finest_cell);
    for (std::size_t i = begin; i < end; ++i) {
      const float x = points.x()[i], y = points.y()[i];
      if (!(x >= 0 && x < width && y >= 0 && y < height)) continue;
      const std::size_t cell = level.cell_of(x, y);
      level.nearest[cell] = std::min(level.nearest[cell], points.depth(i));
      ++level.count[cell];
    }
  });
  DepthLevel out = parts.empty() ? empty_level(size, finest_cell) : std::move(parts.front());
  for (std::size_t part = 1; part < parts.size(); ++part)
    for (std::size_t cell = 0; cell < out.nearest.size(); ++cell) {
      out.nearest[cell] = std::min(out.nearest[cell], parts[part].nearest[cell]);
      out.count[cell] += parts[part].count[cell];
    }
  return out;
}

std::vector<DepthLevel> depth_levels(const ScreenPoints& points, const Eigen::Vector2d& size) {
  std::vector<DepthLevel> out{finest_level(points, size)};
  for (int i = 1; i < levels; ++i) {
    const DepthLevel& fine = out.back();
    DepthLevel coarse = empty_level(size, 2 * fine.cell);
    for (std::size_t row = 0; row < fine.rows; ++row)
      for (std::size_t column = 0; column < fine.columns; ++column) {
        const std::size_t from = row * fine.columns + column, to = row / 2 * coarse.columns + column / 2;
        coarse.nearest[to] = std::min(coarse.nearest[to], fine.nearest[from]);
        coarse.count[to] += fine.count[from];
      }
    out.push_back(std::move(coarse));
  }
  return out;
}

/// Pixels of a rectangle that lie inside a polygon, by the even-odd rule at their centres.
struct PolygonMask {
  int left = 0, top = 0, width = 0, height = 0;
  std::vector<std::uint8_t> inside;

  bool operator()(float x, float y) const {
    const int column = static_cast<int>(std::floor(x)) - left, row = static_cast<int>(std::floor(y)) - top;
    return column >= 0 && column < width && row >= 0 && row < height &&
           inside[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column)] !=
               0;
  }
};

PolygonMask polygon_mask(std::span<const Eigen::Vector2d> corners, const ScreenRect& rect) {
  PolygonMask mask;
  mask.left = static_cast<int>(std::floor(rect.min.x()));
  mask.top = static_cast<int>(std::floor(rect.min.y()));
  mask.width = static_cast<int>(std::ceil(rect.max.x())) - mask.left + 1;
  mask.height = static_cast<int>(std::ceil(rect.max.y())) - mask.top + 1;
  mask.inside.assign(static_cast<std::size_t>(mask.width) * static_cast<std::size_t>(mask.height), 0);
  std::vector<double> crossings;
  for (int row = 0; row < mask.height; ++row) {
    const double y = mask.top + row + 0.5;
    crossings.clear();
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Eigen::Vector2d &a = corners[i], &b = corners[(i + 1) % corners.size()];
      if ((a.y() <= y) != (b.y() <= y)) crossings.push_back(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
    }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      const int from = std::max(0, static_cast<int>(std::ceil(crossings[i] - 0.5)) - mask.left);
      const int to = std::min(mask.width, static_cast<int>(std::ceil(crossings[i + 1] - 0.5)) - mask.left);
      const auto line = mask.inside.begin() + static_cast<std::ptrdiff_t>(row) * mask.width;
      if (from < to) std::fill(line + from, line + to, std::uint8_t{1});
    }
  }
  return mask;
}

/// The part of `rect` in the picture and a little around it: a mask of more would hold nothing.
ScreenRect clipped(const ScreenRect& rect, const Eigen::Vector2d& size) {
  return {rect.min.cwiseMax(Eigen::Vector2d(-1, -1)), rect.max.cwiseMin(size + Eigen::Vector2d(1, 1))};
}

bool same_view(const gpu::Camera& a, const gpu::Camera& b) {
  return a.eye == b.eye && a.target == b.target && a.up == b.up && a.fov == b.fov && a.orthographic == b.orthographic &&
         a.shift == b.shift;
}

}  // namespace

void ScreenPoints::set_visible_ids(VisibleIds ids) {
  ids_ = std::move(ids);
  splatted_ = false;
}

void ScreenPoints::set_hidden(const PointSet& hidden) {
  if (hidden == hidden_) return;
  hidden_ = hidden;
  projected_ = false;
}

void ScreenPoints::update(const gpu::Camera& camera, const Eigen::Vector2d& size, std::span<const Vec3> positions,
                          std::uint64_t version) {
  if (projected_ && version == version_ && size == size_ && same_view(camera, camera_) && positions.size() == x_.size())
    return;
  camera_ = camera;
  size_ = size;
  version_ = version;
  projected_ = true;
  splatted_ = false;
  x_.resize(positions.size());
  y_.resize(positions.size());
  depth_.resize(positions.size());

  // Relative to the target, floats are as fine as the picture needs, however far off the scene's origin is.
  Eigen::Matrix4d to_target = Eigen::Matrix4d::Identity();
  to_target.topRightCorner<3, 1>() = camera.target;
  const Eigen::Matrix4d view = gpu::view_matrix(camera) * to_target;
  const Eigen::Matrix4d clip = gpu::projection_matrix(camera, size.x() / size.y()) * view;
  const Eigen::RowVector4f px = (0.5 * size.x() * (clip.row(0) + clip.row(3))).cast<float>();
  const Eigen::RowVector4f py = (0.5 * size.y() * (clip.row(1) + clip.row(3))).cast<float>();
  const Eigen::RowVector4f pw = clip.row(3).cast<float>(), pz = (-view.row(2)).cast<float>();
  const bool hides = !hidden_.empty() && hidden_.size() == positions.size();
  parallel_for(positions.size(), 64 * word_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3f d = (positions[i] - camera.target).cast<float>();
      const float w = pw[0] * d[0] + pw[1] * d[1] + pw[2] * d[2] + pw[3];
      const float x = px[0] * d[0] + px[1] * d[1] + px[2] * d[2] + px[3];
      const float y = py[0] * d[0] + py[1] * d[1] + py[2] * d[2] + py[3];
      const bool before = w > 0 && !(hides && hidden_[i]);
      x_[i] = before ? x / w : nowhere;
      y_[i] = before ? y / w : nowhere;
      depth_[i] = pz[0] * d[0] + pz[1] * d[1] + pz[2] * d[2] + pz[3];
    }
  });
}

float ScreenPoints::pixel_length(float depth) const {
  const double tangent = std::tan(0.5 * camera_.fov * std::numbers::pi / 180);
  const double distance = camera_.orthographic ? camera_.distance() : static_cast<double>(depth);
  return static_cast<float>(2 * tangent * distance / size_.y());
}

void ScreenPoints::splat_depth() const {
  const std::vector<DepthLevel> pictures = depth_levels(*this, size_);
  const auto width = static_cast<float>(size_.x()), height = static_cast<float>(size_.y());
  const float pixel = pixel_length(1);
  // A surface may lie 72 degrees askew before its far side hides within one cell.
  const float slope = 3;
  visible_ = PointSet(size());
  const std::span<std::uint64_t> words = visible_.words();
  parallel_for(words.size(), word_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = 64 * begin; i < std::min(64 * end, size()); ++i) {
      if (!(x_[i] >= 0 && x_[i] < width && y_[i] >= 0 && y_[i] < height)) continue;
      std::size_t level = 0, cell = pictures[0].cell_of(x_[i], y_[i]);
      while (level + 1 < levels && pictures[level].count[cell] < enough) cell = pictures[++level].cell_of(x_[i], y_[i]);
      const float nearest = pictures[level].nearest[cell];
      const float length = camera_.orthographic ? pixel : pixel * nearest;
      if (depth_[i] <= nearest + slope * pictures[level].cell * length) words[i / 64] |= std::uint64_t{1} << (i % 64);
    }
  });
  visible_.recount();
}

const PointSet& ScreenPoints::visible(const ScreenRect& rect) const {
  if (ids_) {
    visible_ = PointSet(size());
    for (const Index i : ids_(clipped(rect, size_)))
      if (i < size() && !visible_[i]) visible_.add(i);
  } else if (!splatted_) {
    splat_depth();
    splatted_ = true;
  }
  return visible_;
}

std::optional<Index> click_point(const ScreenPoints& points, const Eigen::Vector2d& at, double radius) {
  const PointSet near = in_stroke(points, at, at, radius, Depth::VisibleOnly);
  float front = std::numeric_limits<float>::infinity();
  near.each([&](std::size_t i) { front = std::min(front, points.depth(i)); });
  const float behind = front + 2 * static_cast<float>(radius) * points.pixel_length(front);
  std::optional<Index> best;
  float least = std::numeric_limits<float>::infinity();
  near.each([&](std::size_t i) {
    const float distance = (points.at(i) - at.cast<float>()).squaredNorm();
    if (points.depth(i) > behind || distance >= least) return;
    least = distance;
    best = static_cast<Index>(i);
  });
  return best;
}

PointSet in_box(const ScreenPoints& points, const Eigen::Vector2d& corner, const Eigen::Vector2d& opposite,
                Depth depth) {
  return touched(points, {corner.cwiseMin(opposite), corner.cwiseMax(opposite)}, depth,
                 [](float, float) { return true; });
}

PointSet in_polygon(const ScreenPoints& points, std::span<const Eigen::Vector2d> corners, Depth depth) {
  if (corners.size() < 3) return PointSet(points.size());
  ScreenRect rect{corners[0], corners[0]};
  for (const Eigen::Vector2d& corner : corners) rect = {rect.min.cwiseMin(corner), rect.max.cwiseMax(corner)};
  rect = clipped(rect, points.picture_size());
  if (!(rect.min.array() <= rect.max.array()).all()) return PointSet(points.size());
  const PolygonMask mask = polygon_mask(corners, rect);
  return touched(points, rect, depth, mask);
}

PointSet in_stroke(const ScreenPoints& points, const Eigen::Vector2d& from, const Eigen::Vector2d& to, double radius,
                   Depth depth) {
  const Eigen::Vector2d reach(radius, radius);
  const Eigen::Vector2f a = from.cast<float>(), along = (to - from).cast<float>();
  const float length2 = along.squaredNorm(), radius2 = static_cast<float>(radius * radius);
  return touched(points, {from.cwiseMin(to) - reach, from.cwiseMax(to) + reach}, depth, [&](float x, float y) {
    const Eigen::Vector2f d = Eigen::Vector2f(x, y) - a;
    const float t = length2 > 0 ? std::clamp(d.dot(along) / length2, 0.0f, 1.0f) : 0;
    return (d - t * along).squaredNorm() <= radius2;
  });
}

}  // namespace sinew::editor
