#include "apps/editor/manipulation.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>

#include "apps/editor/keys.h"

namespace sinew::editor {

namespace {

using Vec2 = Eigen::Vector2d;

constexpr double degree = std::numbers::pi / 180;
constexpr double end_on = 0.1;  ///< sine between an axis and the line of sight below which it can't be drawn or held
constexpr double ring_edge_on = 0.2;  ///< cosine below which a ring is dragged along, not around
constexpr double turn_snap = 5;       ///< degrees
constexpr double scale_snap = 0.1;
constexpr double middle = 0.3;  ///< of the gizmo's length: nearer to its middle a scale is no quotient of distances

bool is_axis(GizmoPart part) {
  return part == GizmoPart::X || part == GizmoPart::Y || part == GizmoPart::Z;
}
bool is_plane(GizmoPart part) {
  return part == GizmoPart::PlaneX || part == GizmoPart::PlaneY || part == GizmoPart::PlaneZ;
}
/// Column of the axis, or of the plane's normal.
int column_of(GizmoPart part) {
  return (static_cast<int>(part) - static_cast<int>(is_plane(part) ? GizmoPart::PlaneX : GizmoPart::X));
}
GizmoPart part_of(bool plane, int column) {
  return static_cast<GizmoPart>(static_cast<int>(plane ? GizmoPart::PlaneX : GizmoPart::X) + column);
}

Vec3 towards_eye(const gpu::Camera& camera, const Vec3& point) {
  return (camera.orthographic ? Vec3(camera.eye - camera.target) : Vec3(camera.eye - point)).normalized();
}

struct Ray {
  Vec3 from, direction;
};

/// From the eye through a pixel; of an orthographic picture parallel to the view.
Ray ray_at(const gpu::Camera& camera, const Vec2& size, const Vec2& at) {
  Vec3 target;
  const double depth = gpu::project(camera, size, camera.target, target) ? target.z() : 0.5;
  const Vec3 through = gpu::unproject(camera, size, at, depth);
  if (!camera.orthographic) return {camera.eye, (through - camera.eye).normalized()};
  const Vec3 forward = (camera.target - camera.eye).normalized();
  return {through - forward * camera.distance(), forward};
}

double distance_to_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 along = b - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0;
  return (p - a - t * along).norm();
}

bool inside_polygon(const Vec2& p, std::span<const Vec2> corners) {
  bool inside = false;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 &a = corners[i], &b = corners[(i + 1) % corners.size()];
    if ((a.y() <= p.y()) != (b.y() <= p.y()) && p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
      inside = !inside;
  }
  return inside;
}

double distance_to_stroke(const GizmoStroke& stroke, const Vec2& p) {
  if (stroke.filled && inside_polygon(p, stroke.points)) return 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < stroke.points.size(); ++i)
    least = std::min(least, distance_to_segment(p, stroke.points[i], stroke.points[i + 1]));
  if (stroke.closed && !stroke.points.empty())
    least = std::min(least, distance_to_segment(p, stroke.points.back(), stroke.points.front()));
  return least;
}

/// Draws parts of a gizmo into the picture.
struct Tracer {
  const Gizmo& gizmo;
  const gpu::Camera& camera;
  const Vec2& size;
  Vec3 eye = towards_eye(camera, gizmo.centre);
  double length = gizmo.length * gpu::pixel_size(camera, size.y(), gizmo.centre);
  std::vector<std::pair<double, GizmoStroke>> strokes = {};  ///< with how near each is

  /// Nothing where a point is behind the eye.
  void add(GizmoStroke stroke, std::span<const Vec3> points, double nearness) {
    for (const Vec3& p : points) {
      Vec3 at;
      if (!gpu::project(camera, size, p, at)) return;
      stroke.points.push_back(at.head<2>());
    }
    if (stroke.points.size() >= 2) strokes.emplace_back(nearness, std::move(stroke));
  }

  void arrow(int column) {
    const Vec3 axis = gizmo.axes.col(column);
    const double askew = axis.cross(eye).norm();
    if (askew < end_on) return;
    GizmoStroke stroke{part_of(false, column), {}, false, false, std::clamp((askew - end_on) / 0.15, 0.15, 1.0)};
    add(std::move(stroke), std::array{Vec3(gizmo.centre + 0.2 * length * axis), Vec3(gizmo.centre + length * axis)},
        axis.dot(eye));
  }

  void plane(int column) {
    const double facing = std::abs(gizmo.axes.col(column).dot(eye));
    if (facing < end_on) return;
    const Vec3 a = length * gizmo.axes.col((column + 1) % 3), b = length * gizmo.axes.col((column + 2) % 3);
    const double near = 0.36, far = 0.56;
    const std::array corners{Vec3(gizmo.centre + near * a + near * b), Vec3(gizmo.centre + far * a + near * b),
                             Vec3(gizmo.centre + far * a + far * b), Vec3(gizmo.centre + near * a + far * b)};
    GizmoStroke stroke{part_of(true, column), {}, true, true, std::clamp((facing - end_on) / 0.2, 0.15, 1.0)};
    add(std::move(stroke), corners, (a + b).dot(eye) / length);
  }

  /// In the middle, facing the eye.
  void square(double half) {
    const Vec3 up = camera.up - camera.up.dot(eye) * eye;
    const Vec3 b = half * (up.norm() > 1e-9 ? up.normalized() : eye.unitOrthogonal()), a = b.cross(eye);
    const std::array corners{Vec3(gizmo.centre - a - b), Vec3(gizmo.centre + a - b), Vec3(gizmo.centre + a + b),
                             Vec3(gizmo.centre - a + b)};
    add({GizmoPart::Screen, {}, true, true, 1}, corners, 0);
  }

  /// Points of a circle; of an axis ring the run of those on the side of the eye.
  void ring(GizmoPart part, const Vec3& axis, double radius) {
    constexpr int segments = 96;
    const Vec3 first = axis.unitOrthogonal(), second = axis.cross(first);
    const bool whole = !is_axis(part) || std::abs(axis.dot(eye)) > 0.98;
    std::vector<Vec3> points;
    int start = 0;
    const auto at = [&](int i) {
      const double angle = 2 * std::numbers::pi * i / segments;
      return Vec3(radius * (std::cos(angle) * first + std::sin(angle) * second));
    };
    if (!whole)
      while (start < segments && !(at(start).dot(eye) >= 0 && at(start - 1).dot(eye) < 0)) ++start;
    for (int i = 0; i < segments; ++i) {
      const Vec3 p = at(start + i);
      if (!whole && p.dot(eye) < 0) break;
      points.push_back(gizmo.centre + p);
    }
    add({part, {}, whole, false, 1}, points, part == GizmoPart::Screen ? -1 : 0);
  }
};

/// Angle of a pixel seen from another, counterclockwise as one looks at the picture.
double angle_of(const Vec2& from, const Vec2& to) {
  return std::atan2(-(to.y() - from.y()), to.x() - from.x());
}

}  // namespace

std::vector<GizmoStroke> gizmo_strokes(const Gizmo& gizmo, const gpu::Camera& camera, const Vec2& size) {
  Tracer tracer{gizmo, camera, size};
  if (gizmo.kind == GizmoKind::Translate) {
    for (int column = 0; column < 3; ++column) {
      tracer.plane(column);
      tracer.arrow(column);
    }
    tracer.ring(GizmoPart::Screen, tracer.eye, 0.11 * tracer.length);
    if (!tracer.strokes.empty() && tracer.strokes.back().second.part == GizmoPart::Screen) {
      tracer.strokes.back().second.filled = true;
      tracer.strokes.back().first = 0;
    }
  } else if (gizmo.kind == GizmoKind::Scale) {
    for (int column = 0; column < 3; ++column) tracer.arrow(column);
    tracer.square(0.1 * tracer.length);
  } else {
    tracer.ring(GizmoPart::Screen, tracer.eye, 1.18 * tracer.length);
    for (int column = 0; column < 3; ++column)
      tracer.ring(part_of(false, column), gizmo.axes.col(column), tracer.length);
  }
  std::stable_sort(tracer.strokes.begin(), tracer.strokes.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<GizmoStroke> out;
  for (auto& [nearness, stroke] : tracer.strokes) out.push_back(std::move(stroke));
  return out;
}

GizmoPart hit_gizmo(const Gizmo& gizmo, const gpu::Camera& camera, const Vec2& size, const Vec2& at, double reach) {
  GizmoPart best = GizmoPart::None;
  double least = reach;
  for (const GizmoStroke& stroke : gizmo_strokes(gizmo, camera, size)) {
    const double distance = distance_to_stroke(stroke, at);
    if (distance > least) continue;  // of equally near ones the last, which is drawn over the others
    least = distance;
    best = stroke.part;
  }
  return best;
}

std::optional<std::size_t> hit_handle(std::span<const Vec3> balls, const gpu::Camera& camera, const Vec2& size,
                                      const Vec2& at, double reach) {
  std::optional<std::size_t> best;
  double nearest = -1;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    Vec3 p;
    if (!gpu::project(camera, size, balls[i], p) || (p.head<2>() - at).norm() > reach || p.z() <= nearest) continue;
    nearest = p.z();
    best = i;
  }
  return best;
}

Manipulation::Manipulation(const Gizmo& gizmo, GizmoPart part, const Vec2& at, double snap)
    : gizmo_(gizmo),
      part_(part == GizmoPart::None ? GizmoPart::Screen : part),
      grabbed_(part_),
      last_(at),
      begin_(at),
      cursor_(at),
      snap_(snap) {
  motion_.pivot = gizmo.centre;
}

void Manipulation::move_mouse(const Vec2& at, const gpu::Camera& camera, const Vec2& size, int modifiers) {
  if (state_ != State::Running) return;
  const double speed = modifiers & modifier::shift ? 0.1 : 1;
  const Vec2 before = cursor_;
  cursor_ += speed * (at - last_);
  last_ = at;
  camera_ = camera;
  size_ = size;
  snapping_ = (modifiers & modifier::control) != 0;
  seen_ = true;
  if (gizmo_.kind == GizmoKind::Rotate) turn(before, cursor_);
  solve();
}

bool Manipulation::press(int key, int modifiers) {
  if (state_ != State::Running) return false;
  if (key == key::escape) {
    cancel();
    return true;
  }
  if (key == key::enter || key == key::pad_enter) {
    confirm();
    return true;
  }
  if (key >= 'X' && key <= 'Z' && (modifiers & (modifier::control | modifier::alt)) == 0) {
    const bool plane = (modifiers & modifier::shift) != 0 && gizmo_.kind != GizmoKind::Rotate;
    const GizmoPart wanted = part_of(plane, key - 'X');
    part_ = part_ == wanted ? GizmoPart::Screen : wanted;
  } else if (key >= '0' && key <= '9') {
    typed_ += static_cast<char>(key);
  } else if (key >= key::pad_0 && key <= key::pad_0 + 9) {
    typed_ += static_cast<char>('0' + key - key::pad_0);
  } else if ((key == '.' || key == key::pad_decimal) && typed_.find('.') == std::string::npos) {
    typed_ += '.';
  } else if (key == '-' || key == key::pad_subtract) {
    typed_ = typed_.starts_with('-') ? typed_.substr(1) : '-' + typed_;
  } else if (key == key::backspace && !typed_.empty()) {
    typed_.pop_back();
  } else {
    return false;
  }
  solve();
  return true;
}

void Manipulation::cancel() {
  state_ = State::Cancelled;
  motion_ = {};
  motion_.pivot = gizmo_.centre;
}

std::optional<double> Manipulation::typed() const {
  if (typed_.empty()) return std::nullopt;
  double value = 0;
  const auto [end, error] = std::from_chars(typed_.data(), typed_.data() + typed_.size(), value);
  return error == std::errc() && std::isfinite(value) ? value : 0;
}

Vec3 Manipulation::axis() const {
  return is_axis(part_) ? Vec3(gizmo_.axes.col(column_of(part_))) : Vec3(0, 0, 0);
}

void Manipulation::solve() {
  const std::optional<double> value = typed();
  if (!seen_ && !value) return;
  if (gizmo_.kind == GizmoKind::Translate) {
    motion_.move = translation();
    return;
  }
  if (gizmo_.kind == GizmoKind::Scale) {
    motion_.stretch = stretch();
    return;
  }
  const Vec3 eye = seen_ ? towards_eye(camera_, gizmo_.centre) : Vec3(0, 0, 1);
  motion_.axis = is_axis(part_) ? axis() : eye;
  double degrees = motion_.axis.dot(eye) < 0 ? -degrees_ : degrees_;
  if (snapping_) degrees = std::round(degrees / turn_snap) * turn_snap;
  motion_.degrees = value.value_or(degrees);
}

/// How many times as long, along the axes that it is held to.
double Manipulation::factor() const {
  if (const std::optional<double> value = typed()) return std::max(least_scale, *value);
  Vec3 centre, tip;
  if (!gpu::project(camera_, size_, gizmo_.centre, centre)) return 1;
  const Vec2 from = begin_ - centre.head<2>(), to = cursor_ - centre.head<2>();
  double out = 1;
  const Vec3 along = is_axis(grabbed_) ? Vec3(gizmo_.axes.col(column_of(grabbed_))) : Vec3(0, 0, 0);
  const double step = gpu::pixel_size(camera_, size_.y(), gizmo_.centre);
  if (is_axis(grabbed_) && gpu::project(camera_, size_, gizmo_.centre + step * along, tip)) {
    const Vec2 line = (tip - centre).head<2>().normalized();
    out = std::abs(from.dot(line)) > 1 ? to.dot(line) / from.dot(line) : 1;
  } else if (from.norm() < middle * gizmo_.length) {
    const Vec2 way = cursor_ - begin_;
    out = 1 + (way.x() - way.y()) / gizmo_.length;
  } else {
    out = to.norm() / from.norm();
  }
  if (snapping_) out = std::round(out / scale_snap) * scale_snap;
  return std::isfinite(out) ? std::max(least_scale, out) : 1;
}

Mat3 Manipulation::stretch() const {
  const double by = factor();
  if (by == 1) return Mat3::Identity();
  Vec3 factors = Vec3::Constant(by);
  if (is_axis(part_)) factors = Vec3::Ones();
  if (is_axis(part_) || is_plane(part_)) factors[column_of(part_)] = is_axis(part_) ? by : 1;
  const Mat3& axes = gizmo_.axes;
  if (axes == Mat3::Identity()) return factors.asDiagonal();
  const Mat3 out = axes * factors.asDiagonal() * axes.transpose();
  return 0.5 * (out + out.transpose());
}

Vec3 Manipulation::translation() const {
  if (const std::optional<double> value = typed()) {
    const int column = is_axis(part_) ? column_of(part_) : is_plane(part_) ? (column_of(part_) + 1) % 3 : 0;
    return *value * gizmo_.axes.col(column);
  }
  Vec3 move;
  if (is_axis(part_))
    move = translation_along(axis());
  else if (is_plane(part_))
    move = translation_in(gizmo_.axes.col(column_of(part_)));
  else
    move = translation_in((camera_.eye - camera_.target).normalized());
  if (!move.allFinite()) return motion_.move;
  if (snapping_ && snap_ > 0) {
    const Vec3 steps = (gizmo_.axes.transpose() * move / snap_).array().round();
    move = gizmo_.axes * (steps * snap_);
  }
  return move;
}

/// The mouse's way along the axis as it lies in the picture: exact where the mouse is on the line, and never wild where
/// the line runs away from the eye.
Vec3 Manipulation::translation_along(const Vec3& axis) const {
  const Vec3 eye = towards_eye(camera_, gizmo_.centre);
  if (axis.cross(eye).norm() < end_on) return motion_.move;
  const auto parameter = [&](const Vec2& at) {
    const Ray ray = ray_at(camera_, size_, at);
    const Vec3 between = ray.from - gizmo_.centre;
    const double b = axis.dot(ray.direction), d = axis.dot(between), e = ray.direction.dot(between);
    return (d - b * e) / (1 - b * b);
  };
  Vec3 centre;
  if (!gpu::project(camera_, size_, gizmo_.centre, centre)) return motion_.move;
  // Only what the mouse does along the line counts.
  const double step = gpu::pixel_size(camera_, size_.y(), gizmo_.centre);
  Vec3 beside;
  if (!gpu::project(camera_, size_, gizmo_.centre + step * axis, beside)) return motion_.move;
  const Vec2 line = (beside - centre).head<2>().normalized();
  const Vec2 on_line = begin_ + line * line.dot(cursor_ - begin_);
  return (parameter(on_line) - parameter(begin_)) * axis;
}

Vec3 Manipulation::translation_in(const Vec3& normal) const {
  const auto hit = [&](const Vec2& at) -> Vec3 {
    const Ray ray = ray_at(camera_, size_, at);
    const double facing = normal.dot(ray.direction), t = normal.dot(gizmo_.centre - ray.from) / facing;
    if (std::abs(facing) < 0.02 || t < 0) return Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
    return ray.from + t * ray.direction;
  };
  return hit(cursor_) - hit(begin_);
}

/// Adds the turn of the mouse about the middle, or along a ring that is seen from its edge; beyond 180 degrees too.
void Manipulation::turn(const Vec2& from, const Vec2& to) {
  Vec3 centre;
  if (!gpu::project(camera_, size_, gizmo_.centre, centre)) return;
  const Vec3 eye = towards_eye(camera_, gizmo_.centre);
  if (const Vec3 a = axis(); is_axis(part_) && std::abs(a.dot(eye)) < ring_edge_on) {
    const double step = gpu::pixel_size(camera_, size_.y(), gizmo_.centre);
    Vec3 beside;
    if (!gpu::project(camera_, size_, gizmo_.centre + step * a.cross(eye).normalized(), beside)) return;
    const double along = (to - from).dot((beside - centre).head<2>().normalized());
    degrees_ += (a.dot(eye) < 0 ? -1 : 1) * along / gizmo_.length / degree;
    return;
  }
  const Vec2 middle = centre.head<2>();
  if ((from - middle).norm() < 2 || (to - middle).norm() < 2) return;
  degrees_ += std::remainder(angle_of(middle, to) - angle_of(middle, from), 2 * std::numbers::pi) / degree;
}

std::string Manipulation::text() const {
  static constexpr const char* names = "XYZ";
  std::string held;
  if (is_axis(part_)) held = std::string(1, names[column_of(part_)]) + " ";
  if (is_plane(part_)) held = std::string{names[(column_of(part_) + 1) % 3], names[(column_of(part_) + 2) % 3]} + " ";
  if (gizmo_.kind == GizmoKind::Scale) held += "× ";
  if (!typed_.empty()) return fmt::format("{}[{}]{}", held, typed_, gizmo_.kind == GizmoKind::Rotate ? "°" : "");
  if (gizmo_.kind == GizmoKind::Rotate) return fmt::format("{}{:.1f}°", held, motion_.degrees);
  if (gizmo_.kind == GizmoKind::Scale) return fmt::format("{}{:.3g}", held, seen_ ? factor() : 1);
  const Vec3 along = gizmo_.axes.transpose() * motion_.move;
  if (is_axis(part_)) return fmt::format("{}{:.4g}", held, along[column_of(part_)]);
  return fmt::format("{}{:.4g}, {:.4g}, {:.4g}", held, motion_.move.x(), motion_.move.y(), motion_.move.z());
}

}  // namespace sinew::editor
