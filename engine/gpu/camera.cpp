#include "engine/gpu/camera.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace sinew::gpu {
namespace {

double half_height_per_distance(const Camera& camera) {
  return std::tan(0.5 * camera.fov * std::numbers::pi / 180);
}

}  // namespace

Eigen::Vector3d up_vector(UpAxis axis) {
  return axis == UpAxis::Y ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ();
}

Eigen::Matrix4d view_matrix(const Camera& camera) {
  const Eigen::Vector3d back = (camera.eye - camera.target).normalized();
  const Eigen::Vector3d right = camera.up.cross(back).normalized();
  Eigen::Matrix3d R;
  R << right.transpose(), back.cross(right).transpose(), back.transpose();
  Eigen::Matrix4d view = Eigen::Matrix4d::Identity();
  view.topLeftCorner<3, 3>() = R;
  view.topRightCorner<3, 1>() = -R * camera.eye;
  return view;
}

Eigen::Matrix4d projection_matrix(const Camera& camera, double aspect) {
  Eigen::Matrix4d P = Eigen::Matrix4d::Zero();
  const double tangent = half_height_per_distance(camera);
  const Eigen::Vector2d shift(camera.shift.x(), -camera.shift.y());
  if (camera.orthographic) {
    const double half_height = tangent * camera.distance();
    P(0, 0) = 1 / (half_height * aspect);
    P(1, 1) = -1 / half_height;
    P.topRightCorner<2, 1>() = shift;
    P(2, 2) = 1 / (camera.far - camera.near);
    P(2, 3) = camera.far / (camera.far - camera.near);
    P(3, 3) = 1;
  } else {
    P(0, 0) = 1 / (tangent * aspect);
    P(1, 1) = -1 / tangent;
    P.block<2, 1>(0, 2) = -shift;
    P(2, 3) = camera.near;
    P(3, 2) = -1;
  }
  return P;
}

Eigen::Matrix4d clip_matrix(const Camera& camera, double aspect) {
  return projection_matrix(camera, aspect) * view_matrix(camera);
}

void fit_depth(Camera& camera, const Bounds& bounds) {
  const double radius = std::max(0.5 * bounds.diagonal(), 1e-6 * camera.distance());
  const double to_centre = (camera.eye - camera.target).normalized().dot(camera.eye - bounds.centre());
  if (camera.orthographic) {
    camera.near = to_centre - 1.01 * radius;
    camera.far = to_centre + 1.01 * radius;
  } else {
    camera.near = std::max(to_centre - 1.01 * radius, 1e-3 * std::max(camera.distance(), 1e-6 * radius));
    camera.far = std::max(to_centre + 1.01 * radius, 2 * camera.near);
  }
}

void frame_bounds(Camera& camera, const Bounds& bounds, double aspect, double fill) {
  Bounds box = bounds;
  if (!(bounds.diagonal() > 0)) {
    box.min = bounds.centre().array() - 0.5 / std::sqrt(3.0);
    box.max = bounds.centre().array() + 0.5 / std::sqrt(3.0);
  }
  // The eight corners, seen along the present direction, must lie within the pyramid of the picture.
  const Eigen::Matrix3d R = view_matrix(camera).topLeftCorner<3, 3>();
  const double tangent = half_height_per_distance(camera) * fill;
  double distance = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d p((corner & 1 ? box.max : box.min).x(), (corner & 2 ? box.max : box.min).y(),
                            (corner & 4 ? box.max : box.min).z());
    const Eigen::Vector3d q = R * (p - box.centre());
    const double across = std::max(std::abs(q.y()), std::abs(q.x()) / aspect) / tangent;
    distance = std::max(distance, camera.orthographic ? across : q.z() + across);
  }
  camera.target = box.centre();
  camera.eye = camera.target + R.row(2).transpose() * distance;
  fit_depth(camera, box);
}

std::vector<Camera> cameras_around(const Camera& camera, UpAxis axis, int count, double degrees, const Bounds& bounds,
                                   double aspect, double fill) {
  const bool whole = std::abs(std::remainder(degrees, 360)) < 1e-9;
  const double step = degrees / std::max(1, whole ? count : count - 1) * (std::numbers::pi / 180);
  std::vector<Camera> out;
  double distance = camera.distance();
  for (int i = 0; i < count; ++i) {
    const Eigen::Matrix3d R = Eigen::AngleAxisd(i * step, up_vector(axis)).toRotationMatrix();
    Camera turned = camera;
    turned.eye = camera.target + R * (camera.eye - camera.target);
    turned.up = R * camera.up;
    if (fill > 0) {
      frame_bounds(turned, bounds, aspect, fill);
      distance = i == 0 ? turned.distance() : std::max(distance, turned.distance());
    }
    out.push_back(turned);
  }
  for (Camera& turned : out) {
    turned.eye = turned.target + (turned.eye - turned.target).normalized() * distance;
    fit_depth(turned, bounds);
  }
  return out;
}

bool look_from(Camera& camera, const std::string& name, UpAxis axis) {
  struct Row {
    const char* name;
    Eigen::Vector3d towards_eye, up;  // with y up
  };
  static const Row rows[] = {
      {"front", {0, 0, 1}, {0, 1, 0}},     {"back", {0, 0, -1}, {0, 1, 0}}, {"left", {-1, 0, 0}, {0, 1, 0}},
      {"right", {1, 0, 0}, {0, 1, 0}},     {"top", {0, 1, 0}, {0, 0, -1}},  {"bottom", {0, -1, 0}, {0, 0, 1}},
      {"iso", {0.62, 0.42, 1}, {0, 1, 0}},
  };
  for (const Row& row : rows) {
    if (name != row.name) continue;
    const auto turned = [axis](const Eigen::Vector3d& v) {
      return axis == UpAxis::Y ? v : Eigen::Vector3d(v.x(), -v.z(), v.y());
    };
    camera.eye = camera.target + turned(row.towards_eye).normalized() * camera.distance();
    camera.up = turned(row.up);
    return true;
  }
  return false;
}

Eigen::Vector3d unproject(const Camera& camera, Eigen::Vector2d size, Eigen::Vector2d at, double depth) {
  const Eigen::Vector4d ndc(2 * at.x() / size.x() - 1, 2 * at.y() / size.y() - 1, depth, 1);
  const Eigen::Vector4d p = clip_matrix(camera, size.x() / size.y()).inverse() * ndc;
  return p.head<3>() / p.w();
}

bool project(const Camera& camera, Eigen::Vector2d size, const Eigen::Vector3d& point, Eigen::Vector3d& out) {
  const Eigen::Vector4d p = clip_matrix(camera, size.x() / size.y()) * point.homogeneous();
  if (!(p.w() > 0)) return false;
  out = {(0.5 + 0.5 * p.x() / p.w()) * size.x(), (0.5 + 0.5 * p.y() / p.w()) * size.y(), p.z() / p.w()};
  return true;
}

double pixel_size(const Camera& camera, double height, const Eigen::Vector3d& point) {
  const Eigen::Vector3d forward = (camera.target - camera.eye).normalized();
  const double distance = camera.orthographic ? camera.distance() : std::abs(forward.dot(point - camera.eye));
  return 2 * half_height_per_distance(camera) * distance / height;
}

}  // namespace sinew::gpu
